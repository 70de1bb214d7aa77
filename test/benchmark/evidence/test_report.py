"""The tables separate errors of a session's tracking from those of alignment."""

import pytest
from report import failures_table, outcome_table, together_table, well_tracked


def session(name, tracked_mm):
    return {"id": name, "folder": "", "mesh": "", "problem": "", "camera_rmse_mm": tracked_mm}


def pair(a, b, accepted, right):
    candidate = {"right": right, "probability": 0.9, "rotation_error_deg": 1.0, "translation_error_mm": 1.0,
                 "overlap_ratio": 0.5, "color_agreement": 0.5, "contact_gap_m": 0.001, "fsv_ratio": 0.01}
    return {"a": a, "b": b, "same_object": True, "accepted": accepted, "true_overlap_ratio": 0.6, "true_turn_rad": 1.5,
            "candidates": [candidate], "seconds": 1.0, "reason": "some reason"}


@pytest.fixture
def report(tmp_path):
    (tmp_path / "scene.yaml").write_text("depth: {model: tof}\n")
    sessions = [session("good", 0.3), session("also_good", 1.4), session("bad", 7.4)]
    for s in sessions:
        s["folder"] = str(tmp_path)
    return {"sessions": sessions, "pairs": [pair("good", "also_good", True, True), pair("good", "bad", True, False)]}


def test_a_badly_tracked_session_spoils_its_pairs(report):
    sessions = {s["id"]: s for s in report["sessions"]}
    assert [well_tracked(p, sessions) for p in report["pairs"]] == [True, False]


def test_outcomes_are_told_with_and_without_it(report):
    rows = {line.split("|")[1].strip(): [x.strip() for x in line.split("|")[2:7]]
            for line in outcome_table(report).splitlines() if line.startswith("|")}
    assert rows["all with overlap >= 20 %"] == ["2", "1", "50.0 %", "1", "0"]
    assert rows["of them, both tracked within 1.5 mm"] == ["1", "1", "100.0 %", "0", "0"]
    assert rows["sensor: tof"] == ["2", "1", "50.0 %", "1", "0"]


def test_every_failure_is_named_with_its_tracking(report):
    lines = failures_table(report).splitlines()
    assert len(lines) == 3 and "good, bad | wrong | 0.3, 7.4 |" in lines[2]
    assert all(line.count("|") == lines[0].count("|") for line in lines)


def test_sessions_aligned_together_are_counted():
    row = {"object": "box", "sessions": ["a", "b", "c"], "reference_from_session": {"a": None, "b": None}, "seconds": 2.0,
           "right": ["a", "b"]}
    report = {"sessions": [session(s, 0.3) for s in "abc"], "objects": [row, dict(row, right=[])]}
    lines = together_table(report).splitlines()
    assert lines[2].startswith("| box | 3 | 2 | 0 | 1 | 0.3, 0.3, 0.3 |") and lines[3].startswith("| box | 3 | 0 | 2 | 1 |")
    assert lines[4].startswith("| all | 6 | 2 | 2 | 2 |")

"""Tables have the figures of the benchmarks' files, and a file that is broken is named."""

import json

import pytest
import tables


def score(mm):
    return {"ate_mm": {"rmse": mm}, "rpe_mm": {"rmse": 0.24}, "rpe_deg": {"rmse": 0.034}}


def tracked(name, live, refined=None):
    report = {"recording": f"/data/{name}/", "frames": 600, "tracked": 600, "cpu_ms": {"median": 2.16, "p95": 4.44}, "live": live}
    if refined:
        report["refinement"] = {"score": refined}
    return report


@pytest.fixture
def written(tmp_path):
    def write(content, name="figures.json"):
        path = tmp_path / name
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return str(path)

    return write


def printed(capsys, *arguments):
    tables.main(list(arguments))
    return capsys.readouterr().out.splitlines()


def test_tracking_has_errors_refinement_and_time(written, capsys):
    path = written({"recordings": [tracked("kit/mug/session_1", score(0.672), score(0.527))]})
    head, line, row = printed(capsys, "tracking", path)
    assert head == "| recording | tracked | ATE live | RPE | ATE refined | ms a frame, median / p95 |"
    assert line == "| --- | --- | --- | --- | --- | --- |"
    assert row == "| mug/session_1 | 100 % | 0.67 | 0.2, 0.03 deg | 0.53 | 2.2 / 4.4 |"


def test_tracking_without_truth_leaves_cells_empty(written, capsys):
    row = printed(capsys, "tracking", written({"recordings": [dict(tracked("a/b", None), tracked=450)]}))[2]
    assert row == "| a/b | 75.0 % |  |  |  | 2.2 / 4.4 |"


def test_the_calibrated_run_stands_beside_the_other(written, capsys):
    path = written({"recordings": [tracked("a/b", score(0.81)), tracked("a/c", score(0.7))]})
    calibrated = written({"recordings": [tracked("a/b", score(0.41))]}, "calibrated.json")
    head, _, first, second = printed(capsys, "tracking", path, "--calibrated", calibrated)
    assert head.startswith("| recording | tracked | ATE live | offset known |")
    assert first.startswith("| a/b | 100 % | 0.81 | 0.41 |") and second.startswith("| a/c | 100 % | 0.70 |  |")


def test_refinement_has_errors_before_and_after_or_the_problem(written, capsys):
    row = {"recording": "mug", "method": "icp", "keyframes": 30, "wall_s": 3.04, "cpu_s": 5.96, "problem": "",
           "before": {"ate_rmse_mm": 5.59, "rotation_rmse_deg": 1.76}, "after": {"ate_rmse_mm": 0.52, "rotation_rmse_deg": 0.04}}
    lines = printed(capsys, "refinement", written([row, dict(row, problem="no overlap"), {k: row[k] for k in list(row)[:6]}]))
    assert lines[2] == "| mug | icp | 30 | 3.0 | 6.0 | 5.59 -> 0.52 mm | 1.76 -> 0.04° |"
    assert lines[3].endswith("| no overlap |  |") and lines[4].endswith("| 6.0 |  |  |")


def test_session_has_a_column_for_each_stage(written, capsys):
    lines = printed(capsys, "session", written([{"keyframes": 30, "stage_s": {"fuse": 0.84, "surface": 1.9}, "peak_mb": 1337.2}]))
    assert lines[0] == "| keyframes | fuse | surface | peak MB |" and lines[2] == "| 30 | 0.8 | 1.9 | 1337 |"


def test_recordings_are_counted_by_their_table(tmp_path, written, capsys):
    sessions = []
    for name, off_mm in (("wood", (0.2, 1.6, 12.0)), ("plain", (1.0,))):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "scene.yaml").write_text(f"table: {{texture: {name}}}\n")
        sessions += [{"folder": str(folder), "camera_rmse_mm": mm} for mm in off_mm]
    lines = printed(capsys, "recordings", written({"sessions": sessions}, "set.json.judged"))
    assert lines[2:] == ["| wood | 3 | 1.60 | 2 | 1 |", "| plain | 1 | 1.00 | 0 | 0 |"]


def test_sessions_aligned_together_are_those_of_the_evidence(written, capsys):
    report = {"sessions": [{"id": "a", "camera_rmse_mm": 0.3}, {"id": "b", "camera_rmse_mm": 0.4}],
              "objects": [{"object": "box", "sessions": ["a", "b"], "reference_from_session": {"a": [], "b": []},
                           "right": ["a", "b"], "seconds": 2.0}]}
    lines = printed(capsys, "alignment", written(report, "together.json.judged"))
    assert lines[2] == "| box | 2 | 2 | 0 | 0 | 0.3, 0.4 | 2.0 |"


@pytest.mark.parametrize("benchmark", ["tracking", "refinement", "session", "alignment", "recordings"])
@pytest.mark.parametrize("content", ["{\"recordings\": [", "{\"other\": 1}", "[1]", "[]", "null"])
def test_a_broken_file_is_named(written, benchmark, content):
    path = written(content, "broken.json.judged")
    if (benchmark, content) == ("refinement", "[]"):
        return  # no recording was measured: a table without rows
    with pytest.raises(SystemExit) as stopped:
        tables.main([benchmark, path])
    assert path in stopped.value.code and len(stopped.value.code.splitlines()) == 1


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(SystemExit, match="No such file"):
        tables.main(["tracking", str(tmp_path / "none.json")])

"""Tables of what alignment decided, of judged reports."""

import os

import numpy as np
import yaml

ENOUGH_OVERLAP = 0.2  # with less, one alignment cannot be distinguished from another
BINS = [0, 0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95, 1.0001]
FEW_PAIRS = 20  # in a bin: fewer are too few to measure reliability
NOT_TURNED_RAD = 0.17
WELL_TRACKED_MM = 1.5  # rms of the refined camera about the truth: beyond it the part is bent by as much


def same_pose(pair):
    """Whether the object was not turned over: a prior given by an option, not by the weights."""
    return pair["same_object"] and 0 <= (pair["true_turn_rad"] or 0) < NOT_TURNED_RAD


def outcome(pair):
    """"right", "wrong", or "refused"; a pair of two objects is right to be refused."""
    if not pair["accepted"]:
        return "refused"
    return "right" if pair["same_object"] and pair["candidates"][0]["right"] else "wrong"


def group_of(pair, sessions, by):
    """What the object or its recording is, by the object.yaml beside its mesh or by the scene."""
    session = sessions[pair["a"]]
    if by == "sensor":
        path = os.path.join(session["folder"], "scene.yaml")
        with open(path) as text:
            return (yaml.safe_load(text).get("depth") or {}).get("model", "kinect")
    path = os.path.join(os.path.dirname(os.path.join(session["folder"], session["mesh"])), "object.yaml")
    metadata = {}
    if os.path.exists(path):
        with open(path) as text:
            metadata = yaml.safe_load(text) or {}
    return str(metadata.get(by, "scanned"))


def well_recorded(pair, sessions):
    """Whether both recordings were tracked well, and show the surface of the true object as closely."""
    return well_tracked(pair, sessions) and all(sessions[pair[k]]["mesh_distance_mm"] <= WELL_TRACKED_MM for k in "ab")


def well_tracked(pair, sessions):
    """Whether both recordings were tracked well enough for any pose of the pair to be right."""
    return all(sessions[pair[k]]["camera_rmse_mm"] <= WELL_TRACKED_MM for k in "ab")


def counts(pairs):
    result = {"pairs": len(pairs), "right": 0, "wrong": 0, "refused": 0}
    for pair in pairs:
        result[outcome(pair)] += 1
    return result


def row(label, pairs):
    c = counts(pairs)
    share = f"{100 * c['right'] / c['pairs']:.1f} %" if c["pairs"] else ""
    exact = sum(p["accepted"] and p["candidates"][0]["right"] and p["candidates"][0]["rotation_error_deg"] <= 1.5
                and p["candidates"][0]["translation_error_mm"] <= 1.5 for p in pairs)
    return f"| {label} | {c['pairs']} | {c['right']} | {share} | {c['wrong']} | {c['refused']} | {exact} |"


def outcome_table(report):
    """Pairs of one object with enough in common, all and by kind of object, texture and sensor."""
    sessions = {s["id"]: s for s in report["sessions"]}
    same = [p for p in report["pairs"] if p["same_object"] and not same_pose(p)]
    enough = [p for p in same if p["true_overlap_ratio"] >= ENOUGH_OVERLAP]
    lines = ["| pairs | number | right | | wrong | refused | right within 1.5 deg, 1.5 mm |", "|" + "---|" * 7,
             row("all with overlap >= 20 %", enough),
             row(f"of them, both tracked within {WELL_TRACKED_MM} mm", [p for p in enough if well_tracked(p, sessions)]),
             row("less overlap", [p for p in same if p["true_overlap_ratio"] < ENOUGH_OVERLAP])]
    for by in ("sensor", "kind", "print"):
        groups = [group_of(p, sessions, by) for p in enough]
        for name in sorted(set(groups)):
            lines.append(row(f"{by}: {name}", [p for p, g in zip(enough, groups) if g == name]))
    cross = [p for p in report["pairs"] if not p["same_object"]]
    if cross:
        lines.append(f"\nPairs of two objects: {counts(cross)['wrong']} of {len(cross)} accepted.")
    again = [p for p in report["pairs"] if same_pose(p)]
    if again:
        c = counts(again)
        lines.append(f"\nNot turned over: {c['right']} right, {c['wrong']} wrong, {c['refused']} refused.")
    seconds = [p["seconds"] for p in report["pairs"]]
    lines.append(f"\nSeconds a pair: median {np.median(seconds):.2f}, at most {max(seconds):.2f}.")
    left_out = [s for s in report["sessions"] if s["problem"]]
    lines += [f"\nLeft out: {s['id']}: {s['problem']}" for s in left_out]
    return "\n".join(lines)


def together_table(report):
    """What became of all sessions of each object, aligned together."""
    lines = ["| object | sessions | right | wrong | left out | tracked to mm | s |", "|" + "---|" * 7]
    tracked = {s["id"]: s["camera_rmse_mm"] for s in report["sessions"]}
    total = np.zeros(4, int)
    for row in report["objects"]:
        right, placed, count = len(row["right"]), len(row["reference_from_session"]), len(row["sessions"])
        figures = (count, right, placed - right, count - placed)
        total += figures
        mm = ", ".join(f"{tracked[s]:.1f}" for s in row["sessions"])
        lines.append(f"| {row['object']} | {' | '.join(map(str, figures))} | {mm} | {row['seconds']:.1f} |")
    return "\n".join([*lines, f"| all | {' | '.join(map(str, total))} | | |"])


def reliability_table(report):
    """How often the best pose is right, by the probability that it was given; pairs of one object, turned over."""
    pairs = [p for p in report["pairs"] if p["same_object"] and not same_pose(p) and p["candidates"]]
    given = np.array([p["candidates"][0]["probability"] for p in pairs])
    right = np.array([bool(p["candidates"][0]["right"]) for p in pairs])
    lines = ["| probability | pairs | mean | right | off |", "|" + "---|" * 5]
    for low, high in zip(BINS, BINS[1:]):
        inside = (given >= low) & (given < high)
        if inside.any():
            off = right[inside].mean() - given[inside].mean()
            lines.append(f"| {low:.2f} to {min(high, 1):.2f} | {inside.sum()} | {given[inside].mean():.3f} "
                         f"| {right[inside].mean():.3f} | {100 * off:+.1f} %{'' if inside.sum() >= FEW_PAIRS else ' (few)'} |")
    lines.append(f"\nBrier score {np.mean((given - right) ** 2):.4f}")
    return "\n".join(lines)


def recordings_table(reports):
    """How far the refined camera is off the true one, by the table that the object stood on; all reports together."""
    off_mm = {}
    for session in (s for report in reports for s in report["sessions"]):
        with open(os.path.join(session["folder"], "scene.yaml")) as text:
            table = (yaml.safe_load(text).get("table") or {}).get("texture", "papers")
        off_mm.setdefault(table, []).append(session["camera_rmse_mm"])
    lines = ["| table | recordings | median mm | worse than 1.5 mm | worse than 10 mm |", "|" + "---|" * 5]
    for table, values in sorted(off_mm.items(), key=lambda item: -len(item[1])):
        worse = [sum(mm > limit for mm in values) for limit in (WELL_TRACKED_MM, 10)]
        lines.append(f"| {table} | {len(values)} | {np.median(values):.2f} | {worse[0]} | {worse[1]} |")
    return "\n".join(lines)


def tables_of(report):
    """What a report of pairs, or of sessions aligned together, comes to."""
    if "objects" in report:
        return together_table(report)
    return f"{outcome_table(report)}\n\n{reliability_table(report)}"


def failures_table(report):
    """Every pair that is wrong or refused, with its first candidate and the first that is right."""
    sessions = {s["id"]: s for s in report["sessions"]}
    lines = ["| pair | outcome | tracked to mm | overlap | turn | first: probability, deg, overlap, colour, gap mm, fsv | right one: rank, "
             "probability, overlap, colour, gap mm, fsv | reason |", "|" + "---|" * 8]

    def figures(c):
        return (f"{c['probability']:.2f}, {c['rotation_error_deg']:.1f}, {c['overlap_ratio']:.2f}, "
                f"{c['color_agreement']:.2f}, {1000 * c['contact_gap_m']:.1f}, {c['fsv_ratio']:.3f}")

    for pair in report["pairs"]:
        if not pair["same_object"] or outcome(pair) == "right":
            continue
        rank = next((k for k, c in enumerate(pair["candidates"]) if c["right"]), None)
        first = figures(pair["candidates"][0]) if pair["candidates"] else "none"
        right = "none" if rank is None else f"{rank + 1}, " + figures(pair["candidates"][rank])
        tracked = ", ".join(f"{sessions[pair[k]]['camera_rmse_mm']:.1f}" for k in "ab")
        lines.append(f"| {pair['a']}, {pair['b']} | {outcome(pair)} | {tracked} | {pair['true_overlap_ratio']:.2f} "
                     f"| {np.degrees(pair['true_turn_rad'] or 0):.0f} | {first} | {right} | {pair['reason'][:90]} |")
    return "\n".join(lines)

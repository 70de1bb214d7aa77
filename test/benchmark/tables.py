#!/usr/bin/python3
"""Makes the Markdown tables of docs/measurements.md from what the benchmarks write with --json.

`tracking`, `refinement` and `session` need the standard library only. `alignment` and `recordings` print the tables of
evidence/report.py, which needs numpy and yaml, and judge a file first that has no .judged beside it.
"""

import argparse
import json
import os
import sys

EVIDENCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "evidence")


class BrokenFile(Exception):
    """A file that cannot be read, or is not of the benchmark that was named."""


def read(path):
    try:
        with open(path, encoding="utf-8") as text:
            return json.load(text)
    except (OSError, ValueError) as error:
        raise BrokenFile(f"{path}: {error}") from error


def number(value, digits=2):
    """Empty where there is no figure: JSON has null for it."""
    return "" if value is None else f"{value:.{digits}f}"


def markdown(head, rows):
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head), *rows])


def name_of(recording):
    return "/".join(recording.rstrip("/").split("/")[-2:])


def percent(part, whole):
    return f"{100 * part / whole:.1f}".replace("100.0", "100") + " %" if whole else ""


def ate(score):
    return number(score["ate_mm"]["rmse"] if score else None)


def rpe(score):
    if not score or not score["rpe_mm"]:
        return ""
    return f"{score['rpe_mm']['rmse']:.1f}, {score['rpe_deg']['rmse']:.2f} deg"


def tracking(report, calibrated=None):
    """Errors in mm. `calibrated`: of the same recordings, with the colour offset known. Times are processor time."""
    offset_known = {r["recording"]: ate(r["live"]) for r in (calibrated or {"recordings": []})["recordings"]}
    rows = []
    for r in report["recordings"]:
        refined = r.get("refinement")
        cells = [name_of(r["recording"]), percent(r["tracked"], r["frames"]), ate(r["live"]), rpe(r["live"]),
                 ate(refined["score"]) if refined else "", f"{r['cpu_ms']['median']:.1f} / {r['cpu_ms']['p95']:.1f}"]
        if calibrated:
            cells.insert(3, offset_known.get(r["recording"], ""))
        rows.append(cells)
    head = ["recording", "tracked", "ATE live", "RPE", "ATE refined", "ms a frame, median / p95"]
    if calibrated:
        head.insert(3, "offset known")
    return markdown(head, rows)


def refinement(report):
    """Rows without truth have no errors; one that failed has its problem instead."""
    rows = []
    for r in report:
        before, after = r.get("before"), r.get("after")
        errors = [r["problem"], ""]
        if not r["problem"] and before and after:
            errors = [f"{before['ate_rmse_mm']:.2f} -> {after['ate_rmse_mm']:.2f} mm",
                      f"{before['rotation_rmse_deg']:.2f} -> {after['rotation_rmse_deg']:.2f}°"]
        rows.append([r["recording"], r["method"], str(r["keyframes"]), number(r["wall_s"], 1), number(r["cpu_s"], 1), *errors])
    return markdown(["recording", "method", "keyframes", "s", "s of cores", "ATE RMSE", "rotation RMSE"], rows)


def session(report):
    """Seconds of each stage, in the order of the first row's file."""
    stages = list(report[0]["stage_s"])
    rows = [[str(r["keyframes"]), *(number(r["stage_s"].get(stage), 1) for stage in stages), number(r["peak_mb"], 0)]
            for r in report]
    return markdown(["keyframes", *stages, "peak MB"], rows)


def judged(path):
    """Report of benchmark_alignment whose poses were judged by the true meshes."""
    if path.endswith(".judged"):
        return read(path)
    read(path)  # reports a malformed file before minutes of judging
    from alignment_evidence import read as judge  # pylint: disable=import-outside-toplevel

    return judge([path])[0]


def run(arguments):
    if arguments.benchmark in ("alignment", "recordings"):
        sys.path.insert(0, EVIDENCE)
        from report import recordings_table, tables_of  # pylint: disable=import-outside-toplevel

        reports = [judged(path) for path in arguments.json]
        if arguments.benchmark == "recordings":
            return recordings_table(reports)
        return "\n\n".join(tables_of(report) for report in reports)
    if arguments.benchmark == "tracking":
        calibrated = read(arguments.calibrated) if arguments.calibrated else None
        return "\n\n".join(tracking(read(path), calibrated) for path in arguments.json)
    table = {"refinement": refinement, "session": session}[arguments.benchmark]
    return "\n\n".join(table(read(path)) for path in arguments.json)


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("benchmark", choices=["tracking", "refinement", "session", "alignment", "recordings"])
    parser.add_argument("json", nargs="+", metavar="FILE.json", help="what benchmark_<benchmark> --json wrote")
    parser.add_argument("--calibrated", metavar="FILE.json",
                        help="tracking: the same recordings with --noise-model, for the column `offset known`")
    arguments = parser.parse_args(argv)
    try:
        print(run(arguments))
    except BrokenFile as error:
        sys.exit(str(error))
    except (KeyError, TypeError, IndexError, AttributeError) as error:
        sys.exit(f"{', '.join(arguments.json)}: not what a benchmark of {arguments.benchmark} writes: "
                 f"{type(error).__name__} {error}")


if __name__ == "__main__":
    main()

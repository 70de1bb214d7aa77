#!/usr/bin/python3
"""Our tracker and the peers on the same recordings, on one core each; one table as Markdown and JSON.

The peers' results do not change with our code: they are kept in --results and taken from there when they exist
(--again runs them again). Processor time is what counts in the table: it is the same on a busy machine.
"""

import argparse
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
OURS, OURS_REFINED = "ours", "ours, refined"
OPENCV_METHODS = ("rgbd", "rgbd_icp")


def on_one_core(arguments, command):
    """stdout of a command that may use one core only."""
    return subprocess.run(["taskset", "-c", str(arguments.core), *command], check=True, text=True,
                          stdout=subprocess.PIPE).stdout


def frame_options(recording):
    """Recordings whose first frames are bad are given as PATH:SKIP."""
    path, _, skip = recording.partition(":")
    return path.rstrip("/"), ["--skip", skip or "0"]


def name_of(path):
    return "_".join(path.split("/")[-2:]) if os.path.basename(path).startswith(("session", "turntable", "jerky")) \
        else os.path.basename(path)


def run_opencv(arguments, method, path, options, base):
    text = on_one_core(arguments, [os.path.join(arguments.build, "opencv_odometry"), path, "--method", method,
                                   "--out", base + ".txt", *options])
    return {f"OpenCV {method}": {"trajectory": base + ".txt", **json.loads(text)}}


def run_open3d(arguments, path, options, base):
    text = on_one_core(arguments, [sys.executable, os.path.join(HERE, "open3d_odometry.py"), path, "--out",
                                   base + ".txt", "--loop-closures", base + "_loop.txt", *options])
    result = json.loads(text)
    total_ms = 1e3 * (result["cpu_s"] + result["loop_cpu_s"]) / result["frames"]
    return {"Open3D hybrid": {"trajectory": base + ".txt", **result},
            "Open3D + loops": {"trajectory": base + "_loop.txt", **result, "cpu_ms": {"median": total_ms}}}


def run_ours(arguments, path, options, base):
    on_one_core(arguments, [os.path.join(arguments.build, "benchmark_tracking"), path, "--refine", "--events", "--out",
                            os.path.dirname(base), "--json", base + ".json", *options, *arguments.ours_option])
    with open(base + ".json") as text:
        result = json.load(text)["recordings"][0]
    common = {"frames": result["frames"], "lost": result["frames"] - result["tracked"]}
    results = {OURS: {"trajectory": result["trajectory"], **common, "cpu_ms": result["cpu_ms"]}}
    refinement = result["refinement"]
    if refinement["trajectory"]:
        total_ms = 1e3 * refinement["cpu_s"] / result["frames"] + result["cpu_ms"]["mean"]
        results[OURS_REFINED] = {"trajectory": refinement["trajectory"], **common, "cpu_ms": {"median": total_ms}}
    return results


def score(arguments, path, trajectory):
    command = [sys.executable, os.path.join(arguments.eval, "score_trajectory.py"), trajectory,
               os.path.join(path, "groundtruth.txt")]
    events = os.path.join(path, "events.yaml")
    if os.path.exists(events):
        command += ["--events", events]
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    return json.loads(done.stdout) if done.stdout else {"error": "not scored"}


def kept(arguments, path, run):
    """The result in the file `path`, or that of run(), then written to it."""
    if os.path.exists(path) and not arguments.again:
        with open(path) as text:
            return json.load(text)
    if arguments.kept_only:
        return {}
    result = run()
    with open(path, "w") as text:
        json.dump(result, text, indent=1)
    return result


def results_of(arguments, recording):
    path, options = frame_options(recording)
    base = os.path.join(arguments.results, name_of(path))
    results = {}
    if "ours" in arguments.only:
        results.update(run_ours(arguments, path, options, base + "_ours"))
    for start in arguments.starts:
        peers, peer_options = {}, [*options, "--start", start]
        if "opencv" in arguments.only:
            for method in OPENCV_METHODS:
                own = f"{base}_opencv_{method}_{start}"
                peers.update(kept(arguments, own + ".json",
                                  lambda m=method, b=own, o=peer_options: run_opencv(arguments, m, path, o, b)))
        if "open3d" in arguments.only:
            own = f"{base}_open3d_{start}"
            peers.update(kept(arguments, own + ".json",
                              lambda b=own, o=peer_options: run_open3d(arguments, path, o, b)))
        results.update({f"{method}, {start}": result for method, result in peers.items()})
    for result in results.values():
        result["score"] = score(arguments, path, result["trajectory"])
    return results


def figure(result, key, statistic):
    return (result["score"].get(key) or {}).get(statistic)


def ratio(value, reference):
    return f"{value / reference:.2f}" if value is not None and reference else ""


def cell(value, digits=1):
    return "" if value is None else f"{value:.{digits}f}"


def markdown(table):
    """Ratios are to ours: the refined row is that of the methods that close loops over the whole recording."""
    lines = ["| recording | method | tracked % | ATE mm | max mm | RPE mm/s | RPE deg/s | CPU ms/frame | ATE ratio | "
             "time ratio |", "|" + "---|" * 10]
    for name, results in table.items():
        for method, result in results.items():
            reference = results.get(OURS_REFINED if method.startswith("Open3D + loops") else OURS, {})
            ate, time_ms = figure(result, "ate_mm", "rmse"), result["cpu_ms"]["median"]
            own_ate = figure(reference, "ate_mm", "rmse") if reference else None
            own_ms = reference["cpu_ms"]["median"] if reference else None
            ratios = ["", ""] if method in (OURS, OURS_REFINED) else [ratio(ate, own_ate), ratio(time_ms, own_ms)]
            tracked = 100 * (1 - result["lost"] / result["frames"])
            lines.append("| " + " | ".join(
                [name, method, cell(tracked), cell(ate, 2), cell(figure(result, "ate_mm", "max")),
                 cell(figure(result, "rpe_mm", "rmse"), 2), cell(figure(result, "rpe_deg", "rmse"), 2),
                 cell(time_ms), *ratios]) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="+", help="TUM-style folders with groundtruth.txt; PATH:N skips N frames")
    parser.add_argument("--eval", required=True, help="folder of the evaluation kit (score_trajectory.py)")
    parser.add_argument("--build", required=True, help="folder of benchmark_tracking and opencv_odometry")
    parser.add_argument("--results", required=True, help="folder for trajectories and results")
    parser.add_argument("--only", default="ours,opencv,open3d", type=lambda text: text.split(","),
                        help="which of ours, opencv, open3d; default all")
    parser.add_argument("--starts", default="velocity,last", type=lambda text: text.split(","),
                        help="where the peers' search starts: velocity, last; default both")
    parser.add_argument("--kept-only", action="store_true", help="take only those peers' results that are kept")
    parser.add_argument("--again", action="store_true", help="run the peers again even if their results are kept")
    parser.add_argument("--core", type=int, default=0)
    parser.add_argument("--ours-option", action="append", default=[], help="passed on to benchmark_tracking")
    parser.add_argument("--json", help="also write the table to this file")
    arguments = parser.parse_args()
    os.makedirs(arguments.results, exist_ok=True)
    table = {}
    for recording in arguments.recordings:
        table[name_of(frame_options(recording)[0])] = results_of(arguments, recording)
        print(f"{recording} done", file=sys.stderr)
    print(markdown(table))
    if arguments.json:
        with open(arguments.json, "w") as text:
            json.dump(table, text, indent=1)


if __name__ == "__main__":
    main()

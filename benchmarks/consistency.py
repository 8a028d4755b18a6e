#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures how well consistency measures, which need no truth, predict wrong wraps and map errors,
and how often the verdict, which builds on them, notices a wrong map.

    benchmarks/consistency.py BUILD_DIR RUNS [--frames N] [--jobs N] [--seed-offset N]
    benchmarks/consistency.py --table RUNS

Several methods map simulated recordings of several rooms, with several noises, and with and without
an offset of frequency B that is unknown to them. A line per map is written to the file RUNS as soon
as a recording is mapped. The tables show, for each consistency measure, the rank correlation
(Spearman) with wrong wraps and with the map error, and how well a limit separates maps with an
error above 5 cm from the others; and how many of either are questioned: their verdict, as `map`
gives it without ground truth, is not "Looks right." Needs Debian's python3-numpy and python3-scipy.
"""
import argparse
import concurrent.futures
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy
import scipy.stats

SCENES = (("room", 1), ("hall", 1), ("flat", 1), ("corridor", 1), ("random", 1), ("random", 2),
          ("random", 3))
NOISES_M = (0.02, 0.06, 0.12)
OFFSETS_M = (0, 0.2)  # of frequency B's ranges
METHODS = ("pixel", "jump", "joint")
MEASURES = ("contradicted_percent", "residual_misfit_percent", "residual_rms_cycles",
            "ambiguous_percent", "plane_thickness_m", "view_disagreement_m",
            "curl_violations_per_frame")
WRONG_MAP_M = 0.05


def evaluated(tofmap, frames, threads, recorded):
    """The report of an evaluation of a recording, or nothing if there is no map."""
    (scene, seed), noise_m, offset_m = recorded
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([tofmap, "simulate", scene, "--seed", str(seed), "--frames", str(frames),
                        "--out", f"{folder}/seq", "--quiet",
                        "--set", f"simulator.range_noise_m={noise_m}"], check=True)
        settings = ["pictures.frames=0", "report.frames=0",
                    "evaluation.methods=" + " ".join(METHODS)]
        if offset_m:
            with open(f"{folder}/camera.yaml", "w", encoding="utf-8") as file:
                file.write("format: tofmap-camera\nversion: 1\n"
                           f"error_b:\n  offset_m: {offset_m}\n")
            settings.append(f"camera.calibration_file={folder}/camera.yaml")
        run = subprocess.run([tofmap, "evaluate", f"{folder}/seq", "--out", f"{folder}/out", "--quiet",
                              *(word for one in settings for word in ("--set", one))],
                             stdout=subprocess.DEVNULL, check=False,
                             env={**os.environ, "OMP_NUM_THREADS": str(threads)})
        if run.returncode != 0:
            print(f"{scene} {seed}, {noise_m} m, {offset_m} m: no map", file=sys.stderr)
            return {}
        with open(f"{folder}/out/report.json", encoding="utf-8") as file:
            return json.load(file)


def rows_of(recorded, report):
    (scene, seed), noise_m, offset_m = recorded
    for method, measures in report.get("consistency", {}).items():
        error_m = report["map"][method].get("accuracy_m")
        if error_m is not None:
            yield {"scene": f"{scene} {seed}", "noise_m": noise_m, "offset_m": offset_m,
                   "method": method, **measures,
                   "wrong_wrap_percent": report["unwrapping"][method]["wrong_wrap_percent"],
                   "map_error_m": error_m, **report["judgement"][method]}


def best_limit(values, is_wrong):
    """The limit that best separates wrong maps from right ones, and its balanced accuracy: the mean
    of the shares of wrong and of right maps that it classifies correctly. It is 50 % for a constant
    answer."""
    def told(limit):
        return (numpy.mean(values[is_wrong] > limit) + numpy.mean(values[~is_wrong] <= limit)) / 2
    limit = max((-numpy.inf, *numpy.unique(values)), key=told)
    return limit, told(limit)


def print_measures(rows, is_wrong):
    def column(name):
        return numpy.array([numpy.nan if row[name] is None else row[name] for row in rows])
    print("| measure | with wrong wraps | with map error | limit | balanced accuracy |")
    print("|---|---|---|---|---|")
    for name in MEASURES:
        values = column(name)
        known = numpy.isfinite(values)
        by_wraps, by_error = (scipy.stats.spearmanr(values[known], column(truth)[known])[0]
                              for truth in ("wrong_wrap_percent", "map_error_m"))
        limit, share = best_limit(values[known], is_wrong[known])
        print(f"| `{name}` | {by_wraps:.2f} | {by_error:.2f} | {limit:.2g} | {100 * share:.0f} % |")


def print_verdicts(rows, is_wrong):
    """How many wrong and right maps are questioned, by method, and the exceptions."""
    is_questioned = numpy.array([row["verdict"] != "good" for row in rows])
    methods = numpy.array([row["method"] for row in rows])
    print("| method | wrong maps | questioned | right maps | questioned |")
    print("|---|---|---|---|---|")
    for method in (*METHODS, "all"):
        own = (methods == method) | (method == "all")
        print(f"| {method} | {(own & is_wrong).sum()} | {(own & is_wrong & is_questioned).sum()} | "
              f"{(own & ~is_wrong).sum()} | {(own & ~is_wrong & is_questioned).sum()} |")
    print()
    for row, wrong, questioned in zip(rows, is_wrong, is_questioned):
        if wrong != questioned:
            print(f"{'for nothing' if questioned else 'MISSED'}: {row['scene']}, noise "
                  f"{row['noise_m']} m, offset {row['offset_m']} m, {row['method']}: error "
                  f"{row['map_error_m']:.3f} m. {'; '.join(row['reasons'])}")


def print_tables(runs):
    rows = [json.loads(line) for line in runs.read_text(encoding="utf-8").splitlines()]
    is_wrong = numpy.array([row["map_error_m"] > WRONG_MAP_M for row in rows])
    print(f"{len(rows)} maps, {is_wrong.sum()} of them with an error above {100 * WRONG_MAP_M:g} cm\n")
    print_measures(rows, is_wrong)
    print()
    print_verdicts(rows, is_wrong)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, nargs="?", help="folder of the build")
    parser.add_argument("runs", type=pathlib.Path, help="file with a line per map")
    parser.add_argument("--table", action="store_true", help="only print the tables of RUNS")
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument("--jobs", type=int, default=1, help="recordings to work on side by side")
    parser.add_argument("--seed-offset", type=int, default=0, metavar="N",
                        help="added to the seed of each scene, for recordings of other rooms")
    arguments = parser.parse_args()
    if arguments.table:
        print_tables(arguments.runs)
        return
    tofmap = arguments.build / "apps" / "tofmap"
    threads = max(1, (os.cpu_count() or 1) // arguments.jobs)
    recordings = [((scene, seed + arguments.seed_offset), noise_m, offset_m)
                  for (scene, seed), noise_m, offset_m
                  in itertools.product(SCENES, NOISES_M, OFFSETS_M)]
    with open(arguments.runs, "w", encoding="utf-8") as file, \
            concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        reports = pool.map(lambda one: evaluated(tofmap, arguments.frames, threads, one), recordings)
        for recorded, report in zip(recordings, reports):
            for row in rows_of(recorded, report):
                print(json.dumps(row), file=file, flush=True)
    print_tables(arguments.runs)


if __name__ == "__main__":
    main()

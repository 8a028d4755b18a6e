#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures how well consistency measures, which need no truth, predict wrong wraps and map errors.

    benchmarks/consistency.py BUILD_DIR RUNS [FRAMES]
    benchmarks/consistency.py --table RUNS

Several methods map simulated recordings of several rooms, with several noises, and with and without
an offset of frequency B that is unknown to it. A line per map is written to the file RUNS as soon
as the map is made. The tables show, for each consistency measure, the rank correlation (Spearman)
with wrong wraps and with the map error, and how well a limit separates maps with an error above 5
cm from the others. Needs Debian's python3-numpy and python3-scipy.
"""
import itertools
import json
import subprocess
import sys
import tempfile

import numpy
import scipy.stats

SCENES = (("room", 1), ("hall", 1), ("flat", 1), ("corridor", 1), ("random", 1), ("random", 2),
          ("random", 3))
NOISES_M = (0.02, 0.06, 0.12)
OFFSETS_M = (0, 0.2)  # of frequency B's ranges
METHODS = "none pixel jump joint"
MEASURES = ("contradicted_percent", "residual_misfit_percent", "residual_rms_cycles",
            "ambiguous_percent", "plane_thickness_m", "curl_violations_per_frame")
WRONG_MAP_M = 0.05

# The limits above which `map` and `evaluate` warn (modules/diagnostics/src/consistency.cpp).
MOST_CONTRADICTED_PERCENT = 3
MOST_MISFIT_PERCENT = 10


def evaluated(tofmap, scene, seed, frames, noise_m, offset_m):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([tofmap, "simulate", scene, "--seed", str(seed), "--frames", str(frames),
                        "--out", f"{folder}/seq", "--quiet",
                        "--set", f"simulator.range_noise_m={noise_m}"], check=True)
        settings = ["pictures.frames=0", "report.frames=0", f"evaluation.methods={METHODS}"]
        if offset_m:
            with open(f"{folder}/camera.yaml", "w", encoding="utf-8") as file:
                file.write("format: tofmap-camera\nversion: 1\n"
                           f"error_b:\n  offset_m: {offset_m}\n")
            settings.append(f"camera.calibration_file={folder}/camera.yaml")
        run = subprocess.run([tofmap, "evaluate", f"{folder}/seq", "--out", f"{folder}/out", "--quiet",
                              *(word for one in settings for word in ("--set", one))],
                             stdout=subprocess.DEVNULL, check=False)
        if run.returncode != 0:
            print(f"{scene} {seed}, {noise_m} m, {offset_m} m: no map", file=sys.stderr)
            return {}
        with open(f"{folder}/out/report.json", encoding="utf-8") as file:
            return json.load(file)


def rows_of(report):
    for method, measures in report.get("consistency", {}).items():
        yield ([numpy.nan if measures[name] is None else measures[name] for name in MEASURES],
               report["unwrapping"][method]["wrong_wrap_percent"],
               report["map"][method].get("accuracy_m"))


def best_limit(values, is_wrong):
    """The limit that best separates wrong maps from right ones, and its balanced accuracy: the mean
    of the shares of wrong and of right maps that it classifies correctly. It is 50 % for a constant
    answer."""
    def told(limit):
        return (numpy.mean(values[is_wrong] > limit) + numpy.mean(values[~is_wrong] <= limit)) / 2
    limit = max((-numpy.inf, *numpy.unique(values)), key=told)
    return limit, told(limit)


def print_tables(rows):
    measures, wraps, errors = rows[:, :-2], rows[:, -2], rows[:, -1]
    is_wrong = errors > WRONG_MAP_M
    print(f"{len(errors)} maps, {is_wrong.sum()} of them with an error above {100 * WRONG_MAP_M:g} cm\n")
    print("| measure | with wrong wraps | with map error | limit | balanced accuracy |")
    print("|---|---|---|---|---|")
    for i, name in enumerate(MEASURES):
        known = numpy.isfinite(measures[:, i])
        by_wraps, by_error = (scipy.stats.spearmanr(measures[known, i], truth[known])[0]
                              for truth in (wraps, errors))
        limit, share = best_limit(measures[known, i], is_wrong[known])
        print(f"| `{name}` | {by_wraps:.2f} | {by_error:.2f} | {limit:.2g} | {100 * share:.0f} % |")
    has_warnings = ((measures[:, MEASURES.index("contradicted_percent")] > MOST_CONTRADICTED_PERCENT)
                  | (measures[:, MEASURES.index("residual_misfit_percent")] > MOST_MISFIT_PERCENT))
    print(f"\nwith warnings: {100 * has_warnings[is_wrong].mean():.0f} % of the wrong maps, "
          f"{100 * has_warnings[~is_wrong].mean():.0f} % of the others")


def main():
    if sys.argv[1] == "--table":
        print_tables(numpy.loadtxt(sys.argv[2]))
        return
    tofmap = sys.argv[1] + "/apps/tofmap"
    runs = sys.argv[2]
    frames = int(sys.argv[3]) if len(sys.argv) > 3 else 100
    with open(runs, "w", encoding="utf-8") as file:
        print("#", *MEASURES, "wrong_wrap_percent", "map_error_m", file=file)
        for (scene, seed), noise_m, offset_m in itertools.product(SCENES, NOISES_M, OFFSETS_M):
            report = evaluated(tofmap, scene, seed, frames, noise_m, offset_m)
            rows = [(*values, wrong_percent, error_m)
                    for values, wrong_percent, error_m in rows_of(report) if error_m is not None]
            numpy.savetxt(file, rows, fmt="%.4g")
            file.flush()
    print_tables(numpy.loadtxt(runs))


if __name__ == "__main__":
    main()

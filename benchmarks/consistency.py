#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""How far measures that need no truth tell what only the truth knows.

    benchmarks/consistency.py BUILD_DIR RUNS [FRAMES]
    benchmarks/consistency.py --table RUNS

Every method maps simulated recordings of several rooms, with more and more noise and with a phase
offset that nobody knows of; RUNS gets a line a map, as they are made. The measures of consistency are
set against wrong wraps and the map's error: as rank correlation (Spearman), and by how surely a limit
tells maps that are wrong by more than 5 cm. Needs Debian's python3-numpy and python3-scipy.
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
MEASURES = ("contradicted_percent", "residual_misfit_percent", "residual_rms_cycles",
            "ambiguous_percent", "plane_thickness_m", "curl_violations_per_frame")
WRONG_MAP_M = 0.05

# What `map` and `evaluate` doubt (apps/reports/consistency_report.cpp).
MOST_CONTRADICTED_PERCENT = 3
MOST_MISFIT_PERCENT = 10


def evaluated(tofmap, scene, seed, frames, noise_m, offset_m):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([tofmap, "simulate", scene, "--seed", str(seed), "--frames", str(frames),
                        "--out", f"{folder}/seq", "--quiet",
                        "--set", f"simulator.range_noise_m={noise_m}"], check=True)
        settings = ["pictures.frames=0", "report.frames=0"]
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
    """The limit that tells wrong maps from right ones most surely, and how surely: the mean of the shares
    of both that are told rightly, so that saying the same of all maps is worth 50 %."""
    def told(limit):
        return (numpy.mean(values[is_wrong] > limit) + numpy.mean(values[~is_wrong] <= limit)) / 2
    limit = max((-numpy.inf, *numpy.unique(values)), key=told)
    return limit, told(limit)


def print_tables(rows):
    measures, wraps, errors = rows[:, :-2], rows[:, -2], rows[:, -1]
    is_wrong = errors > WRONG_MAP_M
    print(f"{len(errors)} maps, {is_wrong.sum()} of them wrong by more than {100 * WRONG_MAP_M:g} cm\n")
    print("| measure | with wrong wraps | with map error | limit | told apart |")
    print("|---|---|---|---|---|")
    for i, name in enumerate(MEASURES):
        known = numpy.isfinite(measures[:, i])
        by_wraps, by_error = (scipy.stats.spearmanr(measures[known, i], truth[known])[0]
                              for truth in (wraps, errors))
        limit, share = best_limit(measures[known, i], is_wrong[known])
        print(f"| `{name}` | {by_wraps:.2f} | {by_error:.2f} | {limit:.2g} | {100 * share:.0f} % |")
    has_warnings = ((measures[:, MEASURES.index("contradicted_percent")] > MOST_CONTRADICTED_PERCENT)
                  | (measures[:, MEASURES.index("residual_misfit_percent")] > MOST_MISFIT_PERCENT))
    print(f"\ndoubted: {100 * has_warnings[is_wrong].mean():.0f} % of the wrong maps, "
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

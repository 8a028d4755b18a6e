#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the time of `joint` and `jump` with scikit-image's unwrap_phase on the same scene.

    benchmarks/against_skimage.py [BUILD_DIR]

Prints CPU times on one core, each the best of several runs. unwrap_phase does less: it makes one
phase image continuous, without absolute wrap counts, a second frequency or confidence. Needs
Debian's python3-skimage.
"""
import json
import math
import os
import subprocess
import sys
import tempfile
import time

import numpy
from skimage.io import imread
from skimage.restoration import unwrap_phase

SIZES = [(176, 144), (640, 480)]


def skimage_milliseconds(stored, repetitions):
    """CPU time of one call, the best of several. Pixels without a return are masked."""
    angle = numpy.ma.array(2 * math.pi * stored / 65536 - math.pi, mask=stored == 65535)
    best = math.inf
    for _ in range(repetitions):
        start = time.process_time()
        unwrap_phase(angle)
        best = min(best, time.process_time() - start)
    return 1000 * best


def our_milliseconds(build, method, width, height):
    run = subprocess.run(
        [f"{build}/benchmarks/bench_unwrap_speed",
         f"--benchmark_filter=unwrap/{method}/{width}x{height}/real_time/threads:1$",
         "--benchmark_format=json", "--benchmark_repetitions=3"],
        check=True, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    return min(b["cpu_time"] for b in json.loads(run.stdout)["benchmarks"]
               if b["run_type"] == "iteration")


def main():
    build = sys.argv[1] if len(sys.argv) > 1 else "build"
    print("| size | unwrap_phase, ms | joint, ms | ratio | jump, ms | ratio |")
    print("|---|---|---|---|---|---|")
    for width, height in SIZES:
        with tempfile.TemporaryDirectory() as folder:
            # Two frames are enough, and take less time than a whole recording.
            subprocess.run(
                [f"{build}/apps/tofmap", "simulate", "room", "--out", f"{folder}/room", "--frames", "2",
                 "--quiet", "--set", f"simulator.width_px={width}",
                 "--set", f"simulator.height_px={height}"], check=True)
            stored = imread(f"{folder}/room/phase_a/000001.png").astype(float)
        theirs = skimage_milliseconds(stored, 15 if width < 400 else 5)
        joint = our_milliseconds(build, "joint", width, height)
        jump = our_milliseconds(build, "jump", width, height)
        print(f"| {width} x {height} | {theirs:.1f} | {joint:.1f} | {joint / theirs:.2f} "
              f"| {jump:.1f} | {jump / theirs:.2f} |")


if __name__ == "__main__":
    main()

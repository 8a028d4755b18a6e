#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes recordings of random rooms, each with a trouble that real recordings have.

    benchmarks/troubled_rooms.py BUILD_DIR OUT_DIR [--troubles TROUBLE ...] [--seeds SEED ...]
        [--frames N] [--jobs N]

The seed changes the room, its furniture, the path and the noise. Recordings that are in OUT_DIR are
not made again. verdict_rates.py maps them and counts how often the verdict is right. Needs Debian's
python3-numpy.
"""
import argparse
import concurrent.futures
import itertools
import pathlib
import shutil

from recording import run

TROUBLES = {
    "nothing": [],
    "noise": ["range_noise_m=0.06"],
    "strong_noise": ["range_noise_m=0.12"],
    "fast": ["max_translation_m=0.2", "max_rotation_deg=12"],
    "violent": ["max_translation_m=0.3", "max_rotation_deg=25"],
    "people": ["people=2", "people_range_m=1"],
    "crowd": ["people=4", "people_paths=both", "doors=3"],
    "errors": ["offset_a_m=0.02", "offset_b_m=-0.05", "periodic_a_m=0.03", "periodic_b_m=0.03",
               "amplitude_error_a_m=0.03", "fixed_pattern_m=0.01"],
    "multipath": ["multipath_rays=64"],
    "sunlight": ["ambient_noise=6"],
    "short_sighted": ["max_range_m=3.5"],
}


def make(tofmap, out, trouble, seed, frames):
    folder = out / f"{trouble}_{seed}"
    if folder.exists():
        return
    unfinished = folder.with_suffix(".unfinished")
    shutil.rmtree(unfinished, ignore_errors=True)
    settings = [f"simulator.{setting}" for setting in TROUBLES[trouble]]
    run(tofmap, "simulate", "random", "--out", unfinished, "--seed", seed, "--frames", frames,
        *(["--set", *settings] if settings else []))
    unfinished.rename(folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="folder of the build")
    parser.add_argument("out", type=pathlib.Path, help="folder of recordings")
    parser.add_argument("--troubles", nargs="+", choices=list(TROUBLES), default=list(TROUBLES))
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--frames", type=int, default=120)
    parser.add_argument("--jobs", type=int, default=1, help="recordings to make side by side")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    tofmap = arguments.build / "apps" / "tofmap"
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        list(pool.map(lambda one: make(tofmap, arguments.out, *one, arguments.frames),
                      itertools.product(arguments.troubles, arguments.seeds)))


if __name__ == "__main__":
    main()

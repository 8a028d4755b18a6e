#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints how well `tofmap map` follows a camera that turns suddenly, as in a hand.

    benchmarks/violent_turns.py BUILD_DIR OUT_DIR [--scenes SCENE ...] [--seeds N] [--turns DEG ...]

The camera follows the path of a built-in scene. Now and then, and from the first frame on, it turns
to another direction within two to four frames, stays there for up to eleven frames and turns back.
The turns are 1, 3/4, 1/2 and 1/3 of the largest turn per frame, about axes that are random but
mostly upright. Recordings and maps stay in OUT_DIR; recordings that are there are used again. Needs
Debian's python3-numpy and python3-scipy.
"""
import argparse
import pathlib

import numpy
from scipy.spatial.transform import Rotation, Slerp

import recording

FRAMES = 300
FRAME_RATE_HZ = 15
STEPS = numpy.array([1, 3 / 4, 1 / 2, 1 / 3])


def scene_path(tofmap, scene, folder):
    """Positions and rotations of the camera along the path of a scene, in 10 000 small steps."""
    if not (folder / "groundtruth.txt").exists():
        recording.run(tofmap, "simulate", scene, "--out", folder, "--set", "simulator.frames=10000",
                      "simulator.width_px=8", "simulator.height_px=8", "simulator.subpixels=1")
    rows = numpy.loadtxt(folder / "groundtruth.txt")
    return rows[:, 1:4], Rotation.from_quat(rows[:, 4:8])


def glances(random, largest_turn_deg):
    """A rotation vector for each frame, away from the direction of the path and back to it."""
    offsets = numpy.zeros((FRAMES, 3))
    frame = 1
    while frame < FRAMES - 20:
        axis = random.normal(0, [0.3, 1, 0.3])
        steps = largest_turn_deg * STEPS[:random.integers(2, 5)]
        there = numpy.cumsum(steps)
        stay = numpy.full(random.integers(3, 12), there[-1])
        angles = numpy.concatenate([there, stay, there[-1] - numpy.cumsum(steps)])
        offsets[frame:frame + len(angles)] = numpy.radians(angles)[:FRAMES - frame, None] * (
            axis / numpy.linalg.norm(axis))
        frame += len(angles) + random.integers(10, 40)
    return Rotation.from_rotvec(offsets)


def write_trajectory(file, positions, rotations):
    times = numpy.arange(FRAMES) / FRAME_RATE_HZ
    numpy.savetxt(file, numpy.column_stack([times, positions, rotations.as_quat()]), fmt="%.7f")


def position_errors_m(truth, found):
    """Errors of the positions found, which need not be there for all frames of the truth."""
    by_time = {round(row[0], 4): row[1:4] for row in truth}
    true_m = numpy.array([by_time[round(row[0], 4)] for row in found])
    return recording.position_errors_m(found[:, 1:4], true_m)


def measure(tofmap, out, scene, seed, largest_turn_deg):
    """Prints the row of one recording."""
    name = f"{scene}_{largest_turn_deg:g}_{seed}"
    positions, rotations = scene_path(tofmap, scene, out / f"{scene}_path")
    steps = numpy.arange(len(positions))
    at = numpy.linspace(0, len(positions) - 1, FRAMES)
    turned = Slerp(steps, rotations)(at) * glances(numpy.random.default_rng(seed), largest_turn_deg)
    along = numpy.column_stack([numpy.interp(at, steps, axis) for axis in positions.T])
    write_trajectory(out / f"{name}.txt", along, turned)
    if not (out / name / "sequence.yaml").exists():
        recording.run(tofmap, "simulate", scene, "--out", out / name, "--set",
                      f"simulator.trajectory_file={out / name}.txt")
    recording.run(tofmap, "map", out / name, "--out", out / f"{name}_map")
    found = numpy.loadtxt(out / f"{name}_map" / "trajectory.txt")
    errors_m = position_errors_m(numpy.loadtxt(out / name / "groundtruth.txt"), found)
    turns_deg = numpy.degrees((turned[:-1].inv() * turned[1:]).magnitude())
    print(f"| {scene} | {seed} | {turns_deg.max():.1f} | {(turns_deg > 8).sum()} | "
          f"{len(found)} of {FRAMES} | {1000 * numpy.sqrt((errors_m ** 2).mean()):.1f} | "
          f"{1000 * errors_m.max():.0f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--scenes", nargs="+", default=["flat", "room", "hall"])
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--turns", type=float, nargs="+", default=[17, 28])
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    print("| scene | seed | largest turn, ° | turns > 8° | registered | ATE, mm | largest, mm |\n"
          "|---|---|---|---|---|---|---|")
    for scene in arguments.scenes:
        for turn_deg in arguments.turns:
            for seed in range(1, arguments.seeds + 1):
                measure(arguments.build / "apps" / "tofmap", arguments.out, scene, seed, turn_deg)


if __name__ == "__main__":
    main()

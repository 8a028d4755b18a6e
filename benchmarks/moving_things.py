#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures how much people and doors that move harm maps.

    benchmarks/moving_things.py BUILD_DIR OUT_DIR [--scenes SCENE ...] [--cases CASE ...]
        [--seeds N] [--frames N] [--map OPTION=VALUE ...]

A case says what moves in a scene: nothing, one person or two people ahead of the camera, people who
cover about a third of the image, people on paths of their own, doors, or all together. Each
recording is mapped. The table has the share of pixels that see what moves (mean and largest), the
trajectory error of all registered frames after the rigid alignment that fits best, the mean
distance of map points from the surface that does not move, the share of map points that what moves
has left in the map, and the verdict of report.json, which knows no truth. A map point counts as
left by what moves if it is more than 5 cm from the surface and less than 10 cm from a place at
which a frame saw something moving. That includes doors at rest; the column after it counts only
points that the last frame that looked there saw through. Recordings and maps stay in OUT_DIR, and
are used again. Needs Debian's python3-numpy, python3-scipy, python3-opencv and python3-yaml.
"""
import argparse
import json
import pathlib
import sys

import cv2
import numpy
import yaml
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

import recording
import surface

SCENES = ("flat", "room", "hall", "corridor", "atrium", "passage", "random", "wall", "slope",
          "beyond")
CASES = {
    "nothing": [],
    "one": ["people=1"],
    "two": ["people=2"],
    "third": ["people=2", "people_range_m=1"],
    "own": ["people=3", "people_paths=own"],
    "doors": ["doors=3"],
    "all": ["people=4", "people_paths=both", "doors=3"],
}
OFF_SURFACE_M = 0.05
NEAR_MOVING_M = 0.1


def record(tofmap, scene, case, seed, frames, folder):
    if (folder / "sequence.yaml").exists():
        return
    recording.run(tofmap, "simulate", scene, "--out", folder, "--seed", seed, "--frames", frames,
                  *(word for option in CASES[case] for word in ("--set", "simulator." + option)))


def moving_pixels(sequence):
    """The share of moving pixels in each frame, and the places at which they are (n x 3)."""
    rays = recording.rays(sequence)
    poses = numpy.loadtxt(sequence / "groundtruth.txt", ndmin=2)
    shares, places = [], [numpy.zeros((0, 3))]
    for pose, columns in zip(poses, recording.frames(sequence)):
        name = pathlib.Path(columns[1]).name
        if not (sequence / "moving_truth" / name).exists():
            return numpy.zeros(len(poses)), places[0]
        moving = cv2.imread(str(sequence / "moving_truth" / name), cv2.IMREAD_UNCHANGED) > 0
        range_m = cv2.imread(str(sequence / "range_truth" / name), cv2.IMREAD_UNCHANGED) / 1000
        shares.append(moving.mean())
        seen = Rotation.from_quat(pose[4:8]).apply(rays[moving] * range_m[moving][:, None])
        places.append(surface.thinned(seen + pose[1:4], 0.03))
    return numpy.array(shares), surface.thinned(numpy.concatenate(places), 0.03)


def are_gone(sequence, points):
    """Whether the last frame that looks at a point (n x 3) sees a surface behind it."""
    with open(sequence / "sequence.yaml", encoding="utf-8") as file:
        camera = yaml.safe_load(file)["camera"]
    gone = numpy.zeros(len(points), bool)
    poses = numpy.loadtxt(sequence / "groundtruth.txt", ndmin=2)
    for pose, columns in zip(poses, recording.frames(sequence)):
        name = pathlib.Path(columns[1]).name
        range_m = cv2.imread(str(sequence / "range_truth" / name), cv2.IMREAD_UNCHANGED) / 1000
        seen = Rotation.from_quat(pose[4:8]).apply(points - pose[1:4], inverse=True)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            u = numpy.rint(camera["fx"] * seen[:, 0] / seen[:, 2] + camera["cx"])
            v = numpy.rint(camera["fy"] * seen[:, 1] / seen[:, 2] + camera["cy"])
        inside = ((seen[:, 2] > 0) & (u >= 0) & (u < camera["width"]) &
                  (v >= 0) & (v < camera["height"]))
        looked = numpy.flatnonzero(inside)
        behind_m = (range_m[v[looked].astype(int), u[looked].astype(int)] -
                    numpy.linalg.norm(seen[looked], axis=1))
        reached = behind_m > -NEAR_MOVING_M
        gone[looked[reached]] = behind_m[reached] > NEAR_MOVING_M
    return gone


def score(sequence, folder, swept):
    """The columns of one map: registered frames, errors, moving points and verdict."""
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    poses = numpy.loadtxt(sequence / "groundtruth.txt", ndmin=2)
    truth = {f"{pose[0]:.4f}": pose[1:4] for pose in poses}
    found = numpy.loadtxt(folder / "trajectory.txt", ndmin=2)
    true_m = numpy.array([truth[f"{row[0]:.4f}"] for row in found])
    rotation, translation = recording.best_alignment(found[:, 1:4], true_m)
    errors_m = numpy.linalg.norm(found[:, 1:4] @ rotation.T + translation - true_m, axis=1)
    points = surface.read_ply(folder / "map.ply")[0] @ rotation.T + translation
    off_m = surface.Surface(sequence / "scene.ply").distances_m(points)
    moved = numpy.zeros(len(points), bool)
    far = numpy.flatnonzero(off_m > OFF_SURFACE_M)
    if len(swept) and len(far):
        moved[far] = cKDTree(swept).query(points[far])[0] < NEAR_MOVING_M
    gone = moved.copy()
    gone[moved] = are_gone(sequence, points[moved])
    return (f"{len(found)} of {len(truth)}", f"{1000 * numpy.sqrt((errors_m ** 2).mean()):.1f}",
            f"{1000 * errors_m.max():.0f}", f"{1000 * numpy.minimum(off_m, 5).mean():.1f}",
            f"{len(points)}", f"{100 * moved.mean():.2f}", f"{100 * gone.mean():.2f}",
            report["judgement"]["verdict"])


def measure(arguments, scene, case, seed):
    """Prints the row of one recording."""
    tofmap = arguments.build / "apps" / "tofmap"
    sequence = arguments.out / f"{scene}_{case}_{seed}_{arguments.frames}"
    folder = sequence.with_name(sequence.name + arguments.label)
    record(tofmap, scene, case, seed, arguments.frames, sequence)
    shares, swept = moving_pixels(sequence)
    row = [scene, case, str(seed), f"{100 * shares.mean():.1f}", f"{100 * shares.max():.1f}"]
    if not (folder / "report.html").exists():
        settings = [word for option in arguments.map for word in ("--set", option)]
        try:
            recording.run(tofmap, "map", sequence, "--out", folder, *settings)
        except RuntimeError as error:  # the row says that there is no map
            print(error, file=sys.stderr)
    has_map = (folder / "map.ply").exists()
    row += score(sequence, folder, swept) if has_map else ["no map"] + 7 * ["-"]
    print("| " + " | ".join(row) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--scenes", nargs="+", default=["flat", "room", "hall"], choices=SCENES)
    parser.add_argument("--cases", nargs="+", default=list(CASES), choices=CASES)
    parser.add_argument("--seeds", type=int, default=1, help="seeds 1 to N")
    parser.add_argument("--frames", type=int, default=0,
                        help="only the first N frames of each path; 0: the whole path")
    parser.add_argument("--map", nargs="+", default=[], metavar="OPTION=VALUE",
                        help="options of tofmap map")
    parser.add_argument("--label", default="_map", help="ending of the names of maps")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    print("| scene | moving | seed | pixels, % | largest, % | registered | ATE, mm | largest, mm | "
          "map error, mm | map points | left by what moves, % | seen through at last, % | "
          "verdict |\n" + "|---" * 13 + "|")
    for scene in arguments.scenes:
        for seed in range(1, arguments.seeds + 1):
            for case in arguments.cases:
                measure(arguments, scene, case, seed)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints a table of results of `tofmap register` on single frames of recordings with ground truth.

    benchmarks/cloud_pairs.py BUILD_DIR SEQ...

Every 20th frame becomes a cloud: its true ranges with a noise of 2 cm at 5 m. A pair counts as
right if a point three metres in front of the camera is off by less than 10 cm. Needs Debian's
python3-numpy, python3-opencv and python3-yaml, and an undistorted camera.
"""
import json
import os
import subprocess
import sys
import tempfile

import cv2
import numpy

import recording

EVERY = 20
NOISE_PER_M = 0.02 / 5
AHEAD = numpy.array([0, 0, 3, 1])
RIGHT_WITHIN_M = 0.1
HEADER = ("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
          "property float y\nproperty float z\nend_header\n")


def pose(row):
    x, y, z, w = row[4:8] / numpy.linalg.norm(row[4:8])
    out = numpy.eye(4)
    out[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                   [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                   [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    out[:3, 3] = row[1:4]
    return out


def write_clouds(sequence, folder):
    """Writes the clouds and returns the true pose of each by file name."""
    directions = recording.rays(sequence)
    truth = numpy.loadtxt(f"{sequence}/groundtruth.txt")
    random = numpy.random.default_rng(1)
    poses = {}
    for frame in recording.frames(sequence)[::EVERY]:
        name = os.path.splitext(os.path.basename(frame[1]))[0]
        range_m = cv2.imread(f"{sequence}/range_truth/{name}.png", cv2.IMREAD_UNCHANGED) / 1000.0
        noisy = range_m * (1 + NOISE_PER_M * random.normal(size=range_m.shape))
        points = (directions * noisy[..., None])[range_m > 0].astype("<f4")
        path = f"{folder}/{name}.ply"
        with open(path, "wb") as file:
            file.write(HEADER.format(len(points)).encode() + points.tobytes())
        poses[path] = pose(truth[numpy.argmin(abs(truth[:, 0] - float(frame[0])))])
    return poses


def error_m(found, truth):
    return numpy.linalg.norm(((numpy.reshape(found, (4, 4)) - truth) @ AHEAD)[:3])


def name_of(sequence):
    return os.path.basename(os.path.normpath(sequence))


def registered_pairs(build, sequence):
    """The number of clouds, the pairs of report.json, whether the pose of each pair is right, and
    for each registered cloud the error of its pose relative to the first one, metres."""
    with tempfile.TemporaryDirectory() as folder:
        poses = write_clouds(sequence, folder)
        subprocess.run([f"{build}/apps/tofmap", "register", *poses, "--out", f"{folder}/out",
                        "--quiet"], check=False, stderr=subprocess.DEVNULL)
        with open(f"{folder}/out/report.json", encoding="utf-8") as file:
            pairs = json.load(file)["pairs"]
        with open(f"{folder}/out/transforms.json", encoding="utf-8") as file:
            placed = [c for c in json.load(file)["clouds"] if c["transform"]]
    is_right = []
    for pair in pairs:
        truth = numpy.linalg.inv(poses[pair["target"]]) @ poses[pair["source"]]
        is_right.append(error_m(pair["target_from_source"], truth) < RIGHT_WITHIN_M)
    errors = [error_m(c["transform"], numpy.linalg.inv(poses[placed[0]["path"]]) @ poses[c["path"]])
              for c in placed]
    return len(poses), pairs, is_right, errors


def score(build, sequence):
    clouds, pairs, is_right, errors = registered_pairs(build, sequence)
    registered = [pair["verdict"] == "registered" for pair in pairs]
    right = sum(r and ok for r, ok in zip(registered, is_right))
    wrong = sum(registered) - right
    rejected = sum(is_right) - right
    rms_mm = 1000 * numpy.sqrt(numpy.mean(numpy.square(errors))) if errors else numpy.nan
    print(f"| {name_of(sequence)} | {clouds} | {len(pairs)} | {right} "
          f"| {wrong} | {rejected} | {len(errors)} | {rms_mm:.0f} |", flush=True)


def main():
    print("| recording | clouds | pairs | registered, right | registered, wrong "
          "| rejected, but right | clouds registered | RMS error, mm |\n"
          "|---|---|---|---|---|---|---|---|")
    for sequence in sys.argv[2:]:
        score(sys.argv[1], sequence)


if __name__ == "__main__":
    main()

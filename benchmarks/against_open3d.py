#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares trajectory error and time of Open3D's registration with `tofmap map` on the same ranges.

    benchmarks/against_open3d.py [BUILD_DIR] SEQ...

The ranges come from `tofmap unwrap --filters` without smoothing, with (`joint`) and without
(`none`) unwrapping. Open3D aligns each frame with the one before it, starting from constant
velocity, on voxels of 5 cm. Needs Debian's python3-open3d, python3-numpy, python3-opencv and
python3-yaml, and recordings with ground truth and an undistorted camera.
"""
import os
import subprocess
import sys
import tempfile
import time

import cv2
import numpy
import open3d

import recording

registration = open3d.pipelines.registration
VOXEL_M = 0.05
REACH_M = 0.3
METHODS = {
    "point to plane": lambda source, target, start: registration.registration_icp(
        source, target, REACH_M, start,
        registration.TransformationEstimationPointToPlane()),
    "generalised ICP": lambda source, target, start: registration.registration_generalized_icp(
        source, target, REACH_M, start),
}


def cloud(file, directions):
    range_m = cv2.imread(file, cv2.IMREAD_UNCHANGED) / 1000.0
    points = open3d.geometry.PointCloud()
    points.points = open3d.utility.Vector3dVector((directions * range_m[..., None])[range_m > 0])
    points = points.voxel_down_sample(VOXEL_M)
    points.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(20))
    points.orient_normals_towards_camera_location()
    return points


def positions(clouds, align):
    """The camera positions from aligning successive clouds, and milliseconds per frame."""
    pose, step, path = numpy.eye(4), numpy.eye(4), [numpy.zeros(3)]
    start = time.perf_counter()
    for before, after in zip(clouds, clouds[1:]):
        step = align(after, before, step).transformation
        pose = pose @ step
        path.append(pose[:3, 3])
    return numpy.array(path), 1000 * (time.perf_counter() - start) / max(1, len(clouds) - 1)


def ate_m(path, truth):
    """The absolute trajectory error (RMSE)."""
    return numpy.sqrt(numpy.mean(recording.position_errors_m(path, truth) ** 2))


def truth_at(sequence, times):
    poses = numpy.loadtxt(f"{sequence}/groundtruth.txt")
    return numpy.stack([numpy.interp(times, poses[:, 0], poses[:, axis]) for axis in (1, 2, 3)], 1)


def our_path(tofmap, sequence, method, folder):
    subprocess.run([tofmap, "map", sequence, "--out", f"{folder}/map", "--quiet", "--method", method,
                    "--set", "pictures.frames=0"], check=True)
    return numpy.loadtxt(f"{folder}/map/trajectory.txt", ndmin=2)


def main():
    build, sequences = sys.argv[1], sys.argv[2:]
    tofmap = f"{build}/apps/tofmap"
    print("| ATE, m, unwrapped / wrapped | ours, frames registered | "
          + " | ".join(f"Open3D, {name} | ms per frame" for name in METHODS) + " |")
    print("|---|---|" + "---|---|" * len(METHODS))
    for sequence in sequences:
        directions = recording.rays(sequence)
        ours, theirs = [], {name: [] for name in METHODS}
        with tempfile.TemporaryDirectory() as folder:
            for method in ("joint", "none"):
                path = our_path(tofmap, sequence, method, folder)
                ours.append((ate_m(path[:, 1:4], truth_at(sequence, path[:, 0])), len(path)))
                subprocess.run([tofmap, "unwrap", sequence, "--out", f"{folder}/ranges", "--quiet",
                                "--filters", "--method", method, "--set", "pictures.frames=0",
                                "--set", "filters.chain=isolated_wrap plane_edge"], check=True)
                files = sorted(os.listdir(f"{folder}/ranges/range"))
                clouds = [cloud(f"{folder}/ranges/range/{name}", directions) for name in files]
                times = [float(frame[0]) for frame in recording.frames(sequence)]
                truth = truth_at(sequence, times[:len(clouds)])
                for name, align in METHODS.items():
                    path, milliseconds = positions(clouds, align)
                    theirs[name].append((ate_m(path, truth), milliseconds))
        cells = [f"{ours[0][0]:.4f} / {ours[1][0]:.2f} ({ours[0][1]}, {ours[1][1]})"]
        for found in theirs.values():
            cells += [f"{found[0][0]:.3f} / {found[1][0]:.2f}", f"{found[0][1]:.0f}"]
        print(f"| {os.path.basename(os.path.normpath(sequence))} | " + " | ".join(cells) + " |",
              flush=True)


if __name__ == "__main__":
    main()

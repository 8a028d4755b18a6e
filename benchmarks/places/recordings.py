# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Recordings of walks through buildings whose places look alike, by `tofmap simulate`."""
import shutil
import zlib

import numpy

from places.kinds import KINDS
from places.walk import FRAME_RATE_HZ
from recording import run

CARRIED_S = 4  # time without frames while the camera is carried
LEAST_CLEARANCE_M = 0.3


def building_and_poses(kind, seed):
    """The building of a kind, and positions and rotations of the camera along each of its walks.
    Odd seeds: nothing differs between the places that look alike. Even seeds: one object does."""
    random = numpy.random.default_rng([seed, zlib.crc32(kind.encode())])
    building, walks = KINDS[kind](random, seed % 2 == 0)
    poses = [walk.poses(random) for walk in walks]
    for positions, _ in poses:
        clearance_m = building.clearance_m(positions).min()
        if clearance_m < LEAST_CLEARANCE_M:
            raise ValueError(f"{kind}, seed {seed}: the camera comes within {clearance_m:.2f} m of "
                             "a surface")
    return building, poses


def trajectory(poses):
    """Rows of a TUM trajectory through all walks, and the rows at which a walk ends that another
    one follows."""
    rows, ends, start_s = [], [], 0
    for positions, rotations in poses:
        times_s = start_s + numpy.arange(len(positions)) / FRAME_RATE_HZ
        rows.append(numpy.column_stack([times_s, positions, rotations.as_quat()]))
        start_s = times_s[-1] + CARRIED_S
        ends.append(sum(map(len, rows)) - 1)
    return numpy.vstack(rows), ends[:-1]


def drop_frames(file, dropped):
    """Removes lines from a file with one line a frame, after comments."""
    lines = file.read_text(encoding="utf-8").splitlines()
    first = sum(line.startswith("#") for line in lines)
    kept = [line for index, line in enumerate(lines) if index - first not in dropped]
    file.write_text("\n".join(kept) + "\n", encoding="utf-8")


def make_recording(tofmap, out, kind, seed):
    """Makes the recording of a kind in the folder `out`, if it is not there, and returns it."""
    folder = out / f"{kind}_{seed}"
    if folder.exists():
        return folder
    building, poses = building_and_poses(kind, seed)
    rows, ends = trajectory(poses)
    mesh, path = folder.with_suffix(".ply"), folder.with_suffix(".txt")
    unfinished = folder.with_suffix(".unfinished")
    building.write_ply(mesh)
    numpy.savetxt(path, rows, fmt="%.7f")
    shutil.rmtree(unfinished, ignore_errors=True)
    run(tofmap, "simulate", mesh, "--out", unfinished, "--seed", seed, "--set",
        f"simulator.trajectory_file={path}")
    # The simulator exposes B on the way to the next pose, so the last frame of a walk shows two
    # places.
    for file in ("frames.txt", "groundtruth.txt"):
        drop_frames(unfinished / file, ends)
    unfinished.rename(folder)
    return folder

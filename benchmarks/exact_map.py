# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Copies of maps whose keyframes have their true poses. What is wrong with a camera's poses in
such a map comes from what the camera sees, and not from errors of the map."""
import contextlib
import shutil
import sqlite3

from scipy.spatial.transform import Rotation

from pose_file import poses


def make_exact_map(file, recording, mapped, world):
    """Copies the map that was made from a recording with ground truth, unless the copy is there.
    `world` is the pose of the true world in that of the map."""
    if file.exists():
        return
    unfinished = file.with_suffix(".unfinished")
    shutil.copy(mapped / "map.db", unfinished)
    truth = poses(recording / "groundtruth.txt")
    with contextlib.closing(sqlite3.connect(unfinished)) as database:
        for keyframe, stamp in database.execute("select id, timestamp_s from keyframes").fetchall():
            pose = world @ truth[round(stamp, 4)]
            database.execute(
                "update keyframes set x_m = ?, y_m = ?, z_m = ?, qx = ?, qy = ?, qz = ?, qw = ?,"
                " rotation = ? where id = ?",
                (*pose[:3, 3], *Rotation.from_matrix(pose[:3, :3]).as_quat(),
                 pose[:3, :3].tobytes(order="F"), keyframe))
        database.execute("delete from properties where name = 'checksum'")
        database.commit()
    unfinished.rename(file)

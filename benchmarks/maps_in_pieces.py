#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares maps of a recording that is cut into pieces with a map of it in one go.

    benchmarks/maps_in_pieces.py BUILD_DIR RECORDING OUT_DIR [--pieces N]

The recording needs groundtruth.txt and scene.ply. Each piece is mapped by itself. The maps are then
merged, and each other piece is mapped --onto the one before it, in all orders. A line for each of
these maps has

    frames   share of the frames of the recording that are in it, %
    path     root mean square and largest error of the positions of the camera, mm, after the
             alignment that fits them best to the truth
    surface  mean distance of the points of the map from the true surface, mm, and the share of
             those that are farther than 10 cm from it, %, after the same alignment

Maps that are in OUT_DIR are not made again. Needs Debian's python3-numpy, python3-scipy and
python3-yaml.
"""
import argparse
import contextlib
import itertools
import pathlib
import shutil
import sqlite3

import numpy
from scipy.spatial.transform import Rotation

from recording import best_alignment, frames, make
from surface import Surface, read_ply

FAR_M = 0.1


def cut(recording, folder, first, end):
    """Makes a recording of some of the frames of another one, whose images it refers to."""
    if folder.exists():
        return
    unfinished = folder.with_suffix(".unfinished")
    shutil.rmtree(unfinished, ignore_errors=True)
    unfinished.mkdir(parents=True)
    for entry in recording.iterdir():
        if entry.name not in ("frames.txt", "report.json"):
            (unfinished / entry.name).symlink_to(entry.resolve())
    lines = [" ".join(words) for words in frames(recording)[first:end]]
    (unfinished / "frames.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    unfinished.rename(folder)


def is_made(out, *command):
    """Makes a map. Returns whether there is one: a recording may be refused."""
    try:
        make(out, *command)
    except RuntimeError as error:
        print(f"{out.name}: {str(error).strip().splitlines()[-1]}", flush=True)
    return out.exists()


def path_in(map_file):
    """Timestamps and positions of the camera in the largest map of a file, from all recordings."""
    columns = [f"{table}.{column}" for table in ("keyframes", "frames")
               for column in ("x_m", "y_m", "z_m", "qx", "qy", "qz", "qw")]
    with contextlib.closing(sqlite3.connect(f"file:{map_file}?mode=ro", uri=True)) as database:
        rows = numpy.array(database.execute(
            f"SELECT keyframes.map, frames.timestamp_s, {', '.join(columns)} FROM frames "
            "JOIN keyframes ON frames.keyframe = keyframes.id").fetchall())
    numbers, counts = numpy.unique(rows[:, 0], return_counts=True)
    rows = rows[rows[:, 0] == numbers[counts.argmax()], 1:]
    keyframe_m, rotation, frame_m = rows[:, 1:4], Rotation.from_quat(rows[:, 4:8]), rows[:, 8:11]
    return rows[:, 0], keyframe_m + rotation.apply(frame_m)


def show(folder, recording, surface):
    """Prints the line of a map."""
    truth = numpy.loadtxt(recording / "groundtruth.txt")
    stamps, path = path_in(folder / "map.db")
    nearest = numpy.abs(truth[:, 0] - stamps[:, None]).argmin(axis=1)
    true = truth[nearest, 1:4]
    rotation, translation = best_alignment(path, true)
    errors_mm = 1000 * numpy.linalg.norm(path @ rotation.T + translation - true, axis=1)
    distances_m = surface.distances_m(read_ply(folder / "map.ply")[0] @ rotation.T + translation)
    print(f"{folder.name:14} {100 * len(path) / len(frames(recording)):6.1f} "
          f"{numpy.sqrt((errors_mm ** 2).mean()):6.1f} {errors_mm.max():6.1f} "
          f"{1000 * distances_m[distances_m <= FAR_M].mean():7.1f} "
          f"{100 * (distances_m > FAR_M).mean():6.2f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="folder of the build")
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path, help="folder of pieces and maps")
    parser.add_argument("--pieces", type=int, default=3)
    arguments = parser.parse_args()
    tofmap, out = arguments.build / "apps" / "tofmap", arguments.out
    out.mkdir(parents=True, exist_ok=True)
    surface = Surface(arguments.recording / "scene.ply")
    count, pieces = len(frames(arguments.recording)), arguments.pieces
    print("map            frames   path    max surface  far, %")
    recordings = [out / f"piece_{i + 1}" for i in range(pieces)]
    maps = [out / f"map_{i + 1}" for i in range(pieces)]
    whole = out / "in_one_go"
    if is_made(whole, tofmap, "map", arguments.recording):
        show(whole, arguments.recording, surface)
    for i in range(pieces):
        cut(arguments.recording, recordings[i], i * count // pieces, (i + 1) * count // pieces)
        is_made(maps[i], tofmap, "map", recordings[i])
    for order in itertools.permutations(range(pieces)):
        digits = "".join(str(i + 1) for i in order)
        merged = out / f"merged_{digits}"
        if is_made(merged, tofmap, "merge", *(maps[i] for i in order)):
            show(merged, arguments.recording, surface)
        last = maps[order[0]]
        for length in range(2, pieces + 1):
            onto = out / f"onto_{digits[:length]}"
            if not is_made(onto, tofmap, "map", recordings[order[length - 1]], "--onto", last):
                break
            last = onto
        else:
            show(last, arguments.recording, surface)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures how well a second recording is found in a map, and what has changed is.

    benchmarks/changed_rooms.py BUILD_DIR OUT_DIR [--scenes SCENE ...] [--seeds SEED ...]
        [--frames N] [--moved N] [--set OPTION=VALUE ...]

Each scene is recorded twice, with some of its furniture taken away, put in or moved in between, and
along another path. The first recording is mapped, the second one is mapped onto that and localised
in it. For each scene, a line has

    found    share of the frames of the second recording that were localised, %
    right    share of its frames that were localised within 1 cm and 0.5 degrees, %
    near     the same relative to the keyframe of the map that sees most nearly the same, so that
             most of the map's own errors have no part in it, %
    exact    share of frames that are localised rightly in a copy of the map whose keyframes have
             their true poses, %: what this camera path allows, whatever the errors of the map
    mm, deg  largest error of a localised pose. The frame of the map is aligned with the truth by
             the path of the first recording, from which it was made; the second one has no part
             in that
    prec     share of the points of changes that are on surfaces that changed, %
    recall   share of the surfaces that changed, and that both recordings tell of, that have a
             point of a change nearby, %: three frames of one see the surface, three of the other
             see through it, and the map has it
    moved    pieces that were moved, and changes that are called moved

Recordings and maps that are in OUT_DIR are not made again. Needs Debian's python3-numpy,
python3-scipy and python3-opencv.
"""
import argparse
import json
import pathlib

import cv2
import numpy
import scipy.spatial
from scipy.spatial.transform import Rotation

from exact_map import make_exact_map
from pose_file import poses
from recording import frames, make, rays
from surface import PLY_TYPES, Surface, read_ply, thinned

SCENES = ["wall", "room", "slope", "hall", "corridor", "flat", "passage", "atrium", "beyond",
          "random"]
NEAR_M = 0.06  # one and a half voxels of the map: as far as the mean of a voxel may be off
FREE_M = 0.02  # a range that is longer by this much passes a surface
STORED_M = 0.002  # to how much true ranges are stored, with some reserve
LEAST_VIEWS = 3


def world_of(sequence, result):
    """The pose of the true world in that of a map: the mean over the poses of its recording."""
    truth, path = poses(sequence / "groundtruth.txt"), poses(result / "trajectory.txt")
    there = numpy.array(list(path.values()))
    true = numpy.array([truth[stamp] for stamp in path])
    turned = there[:, :3, :3] @ true[:, :3, :3].transpose(0, 2, 1)
    world = numpy.eye(4)
    world[:3, :3] = Rotation.from_matrix(turned).mean().as_matrix()
    world[:3, 3] = there[:, :3, 3].mean(axis=0) - world[:3, :3] @ true[:, :3, 3].mean(axis=0)
    return world


def errors_of(pose, right):
    """The errors of a pose: position in m, rotation in degrees."""
    turned = Rotation.from_matrix(pose[:3, :3].T @ right[:3, :3])
    return numpy.array([numpy.linalg.norm(pose[:3, 3] - right[:3, 3]),
                        numpy.degrees(turned.magnitude())])


def is_right(errors):
    return (errors <= (0.01, 0.5)).all(axis=-1)


def localisation(world, sequence, result):
    """The shares of frames that are localised, and rightly so, and the largest errors."""
    truth = poses(sequence / "groundtruth.txt")
    errors = numpy.array([errors_of(pose, world @ truth[stamp])
                          for stamp, pose in poses(result / "trajectory.txt").items()])
    largest = errors.max(axis=0)
    return (100 * len(errors) / len(truth), 100 * numpy.count_nonzero(is_right(errors)) /
            len(truth), 1000 * largest[0], largest[1])


def right_near_keyframes(first, mapped, second, result):
    """The share of frames that are right relative to the nearest keyframe of the map."""
    true_first = poses(first / "groundtruth.txt")
    keyframes = poses(mapped / "keyframes.txt")
    truth = poses(second / "groundtruth.txt")
    right = 0
    for stamp, pose in poses(result / "trajectory.txt").items():
        # One radian of rotation changes the view as much as a metre does.
        steps = {key: errors_of(true_first[key], truth[stamp]) @ numpy.array([1, numpy.pi / 180])
                 for key in keyframes}
        nearest = min(steps, key=steps.get)
        wanted = keyframes[nearest] @ numpy.linalg.inv(true_first[nearest]) @ truth[stamp]
        right += is_right(errors_of(pose, wanted))
    return 100 * right / len(truth)


def changed_triangles(before, after):
    """The triangles (n x 3 x 3) of a scene that another one does not have."""
    def corners(file):
        vertices, triangles = read_ply(file)
        return vertices[triangles]

    known = {triangle.tobytes() for triangle in corners(after)}
    return numpy.array([one for one in corners(before) if one.tobytes() not in known])


def sampled(triangles):
    """Points of triangles, about 2 cm apart."""
    points = [numpy.zeros((0, 3))]
    for a, b, c in triangles:
        steps = int(numpy.ceil(numpy.linalg.norm([b - a, c - a, c - b], axis=1).max() / 0.02))
        u, v = (part.ravel() / steps for part in numpy.mgrid[:steps + 1, :steps + 1])
        inside = u + v <= 1 + 1e-9
        points.append(thinned(a + numpy.outer(u[inside], b - a) + numpy.outer(v[inside], c - a),
                              0.02))
    return numpy.concatenate(points)


def seen_in_frames(points, sequence):
    """For each frame of a recording: which points are in its image, their pixels (u, v) and
    distances from the camera, and the true ranges of all pixels."""
    directions = rays(sequence)
    height, width = directions.shape[:2]
    truth = poses(sequence / "groundtruth.txt")
    focal = camera_of(directions)
    for line in frames(sequence):
        file = sequence / "range_truth" / (pathlib.Path(line[1]).stem.split("_")[0] + ".png")
        ranges = cv2.imread(str(file), cv2.IMREAD_UNCHANGED) / 1000
        pose = numpy.linalg.inv(truth[round(float(line[0]), 4)])
        seen = points @ pose[:3, :3].T + pose[:3, 3]
        front = seen[:, 2] > 0.1
        pixels = numpy.full((len(points), 2), -1)
        pixels[front] = numpy.round(
            seen[front, :2] / seen[front, 2:] * focal[0] + focal[1]).astype(int)
        inside = ((pixels >= 0) & (pixels < (width, height))).all(axis=1)
        yield inside, pixels[inside].T, numpy.linalg.norm(seen[inside], axis=1), ranges


def views_through(points, sequence):
    """For each point, the number of frames of a recording that see through it."""
    count = numpy.zeros(len(points), int)
    for inside, (u, v), distances, ranges in seen_in_frames(points, sequence):
        count[inside] += ranges[v, u] > distances + FREE_M
    return count


def views_of(points, sequence):
    """For each point, the number of frames of a recording that see it: its distance is between the
    true ranges of its pixel and of those around it, which are stored in millimetres."""
    around = numpy.ones((3, 3))
    count = numpy.zeros(len(points), int)
    for inside, (u, v), distances, ranges in seen_in_frames(points, sequence):
        least = cv2.erode(ranges, around)[v, u]  # 0 where a ray hits nothing
        largest = cv2.dilate(ranges, around)[v, u]
        count[inside] += ((least > 0) & (distances > least - STORED_M) &
                          (distances < largest + STORED_M))
    return count


def camera_of(directions):
    """Focal lengths and principal point of the camera with these rays."""
    height, width = directions.shape[:2]
    slopes_u = directions[0, :, 0] / directions[0, :, 2]
    slopes_v = directions[:, 0, 1] / directions[:, 0, 2]
    f_u = (width - 1) / (slopes_u[-1] - slopes_u[0])
    f_v = (height - 1) / (slopes_v[-1] - slopes_v[0])
    return numpy.array([f_u, f_v]), numpy.array([-slopes_u[0] * f_u, -slopes_v[0] * f_v])


def changed_points(file):
    """The points of changes.ply, and whether each is of what is there now."""
    if not file.exists():
        return numpy.zeros((0, 3)), numpy.zeros(0, bool)
    with open(file, "rb") as stream:
        fields, count = [], 0
        while (line := stream.readline().split()) != [b"end_header"]:
            words = [part.decode() for part in line]
            if words[0] == "element" and words[1] == "vertex":
                count = int(words[2])
            elif words[0] == "property" and words[1] != "list" and len(words) == 3:
                if words[2] in [name for name, _ in fields] or words[2].startswith("view_p"):
                    break
                fields.append((words[2], PLY_TYPES[words[1]]))
        while line and line != [b"end_header"]:
            line = stream.readline().split()
        rows = numpy.frombuffer(stream.read(count * numpy.dtype(fields).itemsize), fields)
    points = numpy.column_stack([rows[axis].astype(float) for axis in "xyz"])
    return points, numpy.isin(rows["kind"], (1, 3))


class Side:
    """What has gone, or what is new: the truth of one direction of time."""

    def __init__(self, own, other, own_map, world):
        self.triangles = changed_triangles(own / "scene.ply", other / "scene.ply")
        points = sampled(self.triangles)
        if len(points) > 0:
            # Where the other scene has a surface at the same place, nothing has changed.
            points = points[Surface(other / "scene.ply").distances_m(points) > 0.01]
        if len(points) > 0:
            placed = points @ world[:3, :3].T + world[:3, 3]
            mapped = scipy.spatial.cKDTree(read_ply(own_map / "map.ply")[0])
            is_mapped = mapped.query(placed)[0] <= 0.04
            points = points[is_mapped]
        if len(points) > 0:  # sides that face a wall are never seen
            points = points[views_of(points, own) >= LEAST_VIEWS]
        if len(points) > 0:
            points = points[views_through(points, other) >= LEAST_VIEWS]
        self.points = points @ world[:3, :3].T + world[:3, 3]
        self.world = world

    def on_changed(self, points):
        """The number of points that are on a surface that has changed."""
        if len(points) == 0 or len(self.triangles) == 0:
            return 0
        samples = sampled(self.triangles) @ self.world[:3, :3].T + self.world[:3, 3]
        return numpy.count_nonzero(scipy.spatial.cKDTree(samples).query(points)[0] <= NEAR_M)

    def found(self, points):
        """The number of samples of the truth that have a point nearby."""
        if len(points) == 0 or len(self.points) == 0:
            return 0
        return numpy.count_nonzero(scipy.spatial.cKDTree(points).query(self.points)[0] <= NEAR_M)


def changes(first, second, maps, world):
    """Numbers of points: of changes, of those the right ones, of the truth, of those found ones."""
    points, is_now = changed_points(maps["onto"] / "changes.ply")
    gone = Side(first, second, maps["first"], world)
    new = Side(second, first, maps["onto"], world)
    right = gone.on_changed(points[~is_now]) + new.on_changed(points[is_now])
    found = gone.found(points[~is_now]) + new.found(points[is_now])
    return len(points), right, len(gone.points) + len(new.points), found


def moved_pieces(second, result):
    """The number of pieces that were moved, and of changes that are called moved."""
    with open(second / "furniture.json", encoding="utf-8") as file:
        pieces = json.load(file)["pieces"]
    with open(result / "report.json", encoding="utf-8") as file:
        found = json.load(file)["changes"]
    return (sum(piece["state"] == "moved" for piece in pieces),
            sum(change["kind"] == "moved" for change in found))


def percent(part, whole):
    return 100 * part / whole if whole else float("nan")


def evaluate(tofmap, folder, scene, seed, arguments):
    first, second = folder / "first", folder / "second"
    options = [word for one in arguments.set for word in ("--set", f"simulator.{one}")]
    make(first, tofmap, "simulate", scene, "--seed", seed, "--frames", arguments.frames, *options)
    make(second, tofmap, "simulate", scene, "--seed", seed, "--frames", arguments.frames, *options,
         "--set", f"simulator.rearranged={arguments.moved}",
         "--set", f"simulator.arrangement={seed}", "--set", f"simulator.walk={seed}")
    maps = {name: folder / f"map_{name}" for name in ("first", "onto", "found")}
    make(maps["first"], tofmap, "map", first)
    make(maps["onto"], tofmap, "map", second, "--onto", maps["first"])
    make(maps["found"], tofmap, "localise", second, "--in", maps["first"])
    world = world_of(first, maps["first"])
    make_exact_map(folder / "exact.db", first, maps["first"], world)
    make(folder / "found_exact", tofmap, "localise", second, "--in", folder / "exact.db")
    found = localisation(world, second, maps["found"])
    exact = localisation(world, second, folder / "found_exact")
    near = right_near_keyframes(first, maps["first"], second, maps["found"])
    points, right, truth, recalled = changes(first, second, maps, world)
    moved = moved_pieces(second, maps["onto"])
    print(f"{scene:9} {seed:4} {found[0]:6.1f} {found[1]:6.1f} {near:6.1f} {exact[1]:6.1f} "
          f"{found[2]:6.1f} {found[3]:5.2f} {percent(right, points):6.1f} "
          f"{percent(recalled, truth):6.1f} {points:7} {truth:7} {moved[0]:3} {moved[1]:3}",
          flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="folder of the build")
    parser.add_argument("out", type=pathlib.Path, help="folder of recordings and maps")
    parser.add_argument("--scenes", nargs="+", default=SCENES)
    parser.add_argument("--seeds", type=int, nargs="+", default=[11])
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--moved", type=int, default=6, help="pieces of furniture to rearrange")
    parser.add_argument("--set", nargs="+", default=[], help="options of the simulator")
    arguments = parser.parse_args()
    tofmap = arguments.build / "apps" / "tofmap"
    print("scene     seed  found  right   near  exact     mm   deg   prec recall  points   truth "
          "moved as")
    for scene in arguments.scenes:
        for seed in arguments.seeds:
            folder = arguments.out / f"{scene}_{seed}"
            folder.mkdir(parents=True, exist_ok=True)
            try:
                evaluate(tofmap, folder, scene, seed, arguments)
            except RuntimeError as error:
                print(f"{scene:9} {seed:4} {str(error).strip().splitlines()[-1]}", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints a table of what `tofmap register` makes of twenty pairs of laser scans with truth.

    benchmarks/register_pairs.py BUILD_DIR [--clouds FOLDER] [--seeds N...] [--keep FOLDER]

Half of the pairs are impossible: they show different buildings, rooms without overlap, twin rooms,
or storeys of one plan. Fourteen pairs come from simulated buildings (laser_scans.py), which differ
from seed to seed. Six come from clouds of others, in the folders `small_gicp`, `pcl_room` and
`pcl_captures` of FOLDER; they are left out without it. "Moved" clouds were moved out of the frames
of their sensors: one by up to two metres along each axis, the other by up to twenty, with any
rotation. "Limit" clouds have a point at 30 m for each ray without a return; courts are rooms
without a ceiling, which many rays leave.

A pair is right if six points, three metres from the source's sensor, are on average within 10 cm of
their true places. Every other pose is wrong, and so is every pose of an impossible pair. Needs
Debian's python3-vtk9, python3-open3d and python3-numpy.
"""
import argparse
import dataclasses
import json
import os
import subprocess
import tempfile

import numpy
import open3d

import laser_scans
from laser_scans import Scanner, building, scan, standing

RIGHT_WITHIN_M = 0.1
CLEARANCE_M = 0.35  # more than half of the depth of a cupboard
AROUND_M = 3 * numpy.concatenate([numpy.eye(3), -numpy.eye(3)])
LIMIT = Scanner(keeps_limit=True)
PANES = Scanner(keeps_limit=True, sees_panes=0.5)
# Of the scans of pcl_room, whose guess by odometry is wrong by 0.7 m: found from that guess by
# point-to-point ICP in numpy with 60 starts within a metre; the walls of both scans coincide.
ROOM_POSE = numpy.array([[0.75574982, -0.65426841, 0.02783972, 1.96400391],
                         [0.65418790, 0.75621734, 0.01317277, 0.05856271],
                         [-0.02967140, 0.00825709, 0.99952560, 0.01161850], [0, 0, 0, 1]])
NEAR_M, FAR_M = 2, 20
COARSE = Scanner(step_deg=1.1, lowest_deg=-40, highest_deg=60, noise_m=0.01)


@dataclasses.dataclass
class Cloud:
    """The points of a scan, the pose of its frame in the world, and the sensor's place there."""
    points: numpy.ndarray
    world_from_cloud: numpy.ndarray = dataclasses.field(default_factory=lambda: numpy.eye(4))

    def moved(self, reach_m, random):
        """The cloud in an arbitrary frame."""
        turn, _ = numpy.linalg.qr(random.normal(size=(3, 3)))
        move = numpy.eye(4)
        move[:3, :3] = turn * numpy.sign(numpy.linalg.det(turn))
        move[:3, 3] = random.uniform(-reach_m, reach_m, 3)
        points = self.points @ move[:3, :3].T + move[:3, 3]
        return Cloud(points, self.world_from_cloud @ numpy.linalg.inv(move))


@dataclasses.dataclass
class Pair:
    """Two clouds. `sensor` is the place of the source's sensor in the world."""
    name: str
    is_possible: bool
    target: Cloud
    source: Cloud
    sensor: numpy.ndarray

    def moved(self, name, random):
        return dataclasses.replace(self, name=name, target=self.target.moved(NEAR_M, random),
                                   source=self.source.moved(FAR_M, random))

    def error_m(self, target_from_source):
        truth = numpy.linalg.inv(self.target.world_from_cloud) @ self.source.world_from_cloud
        points = transformed(numpy.linalg.inv(self.source.world_from_cloud), self.sensor + AROUND_M)
        off_m = transformed(target_from_source, points) - transformed(truth, points)
        return numpy.linalg.norm(off_m, axis=1).mean()


def transformed(pose, points):
    return points @ pose[:3, :3].T + pose[:3, 3]


class Surveyor:
    """Scans buildings from places near given ones, each time with other noise."""

    def __init__(self, seed):
        self.random = numpy.random.default_rng([seed, 1])

    def near(self, scene, place, away_m=0.0):
        """A pose at some distance from a place, with any heading and a small tilt, and not inside
        of a cupboard."""
        while True:
            side = self.random.uniform(0, 2 * numpy.pi)
            stand = place + away_m * numpy.array([numpy.cos(side), numpy.sin(side), 0])
            if away_m == 0 or scene.clearance_m(stand) > CLEARANCE_M:
                return standing(stand, self.random.uniform(0, 360), self.random.uniform(-2, 2))

    def scan(self, scene, pose, scanner):
        return Cloud(scan(scene, pose, scanner, self.random.integers(1 << 30)), pose)

    def pair(self, name, scenes, places, away_m=1.7, scanners=(Scanner(), Scanner()),
             is_possible=False):
        """Scans of two places. With `away_m`, the second is that far from the one given."""
        first = self.near(scenes[0], places[0])
        second = self.near(scenes[1], places[1], away_m)
        return Pair(name, is_possible, self.scan(scenes[0], first, scanners[0]),
                    self.scan(scenes[1], second, scanners[1]), second[:3, 3].copy())


def possible_pairs(seed, here):
    """Pairs of simulated scans that overlap."""
    plan = 100 * seed
    office, other = building(plan + 1), building(plan + 2)
    courts = building(plan + 1, has_ceiling=False)
    bare = here.pair("room", [other] * 2, [other.rooms[0]] * 2, is_possible=True)
    limit = here.pair("court, limit", [courts] * 2, [courts.rooms[1]] * 2, scanners=(LIMIT, LIMIT),
                      is_possible=True)
    return [limit, limit.moved("court, limit, moved", here.random),
            bare.moved("room, moved", here.random),
            here.pair("room, panes, limit", [office] * 2, [office.rooms[3]] * 2,
                      scanners=(PANES, PANES), is_possible=True),
            here.pair("room, two scanners", [other] * 2, [other.rooms[4]] * 2,
                      scanners=(LIMIT, COARSE), is_possible=True),
            here.pair("corridor", [other] * 2, [other.corridor[1]] * 2, is_possible=True)]


def impossible_pairs(seed, here):
    """Pairs of simulated scans that show different places."""
    plan = 100 * seed
    office, upper = building(plan + 3), building(plan + 3, storey=1)
    twins = building(plan + 5, twins=True)
    lift = numpy.array([0, 0, 40.0])  # other buildings and storeys are somewhere else
    courts = [building(plan + index, has_ceiling=False) for index in (3, 4)]
    limits = (LIMIT, LIMIT)
    two = here.pair("two courts, limit", courts, [court.rooms[1] for court in courts],
                    scanners=limits)
    storeys = here.pair("storeys", [office, upper], [office.rooms[2]] * 2)
    twin = here.pair("twin rooms", [twins] * 2, twins.rooms[:2])
    pairs = [two, two.moved("two courts, limit, moved", here.random),
             storeys, storeys.moved("storeys, moved", here.random),
             here.pair("storeys, limit", [office, upper], [office.rooms[4]] * 2, scanners=limits),
             here.pair("rooms apart", [office] * 2, [office.rooms[0], office.rooms[5]]),
             twin, twin.moved("twin rooms, moved", here.random)]
    for pair in pairs:
        if pair.name.startswith(("two", "storeys")):
            pair.source.world_from_cloud[:3, 3] += lift
            pair.sensor = pair.sensor + lift
    return pairs


def read_points(file):
    """The finite points of a PLY or PCD file."""
    cloud = open3d.io.read_point_cloud(file, remove_nan_points=True, remove_infinite_points=True)
    return numpy.asarray(cloud.points)


def real_pairs(folder, here):
    """Pairs of clouds of others."""
    def at(place):
        return numpy.loadtxt(f"{folder}/{place}")
    def street(name):
        return read_points(f"{folder}/small_gicp/{name}.ply")
    def room(index):
        return read_points(f"{folder}/pcl_room/room_scan{index}.pcd")
    source_pose = at("small_gicp/T_target_source.txt")
    outdoors = Pair("outdoors", True, Cloud(street("target")), Cloud(street("source"), source_pose),
                    source_pose[:3, 3].copy())
    rooms = Pair("real room", True, Cloud(room(1)), Cloud(room(2), ROOM_POSE), ROOM_POSE[:3, 3])
    capture = Cloud(read_points(f"{folder}/pcl_captures/capture0001.pcd"))
    return [outdoors, outdoors.moved("outdoors, moved", here.random), rooms,
            rooms.moved("real room, moved", here.random),
            Pair("real room, outdoors", False, rooms.target, outdoors.source, numpy.zeros(3)),
            Pair("real room, Kinect", False, rooms.source, capture, numpy.zeros(3))]


@dataclasses.dataclass
class Outcome:
    """What the program says of a pair; the error is None if it was not placed."""
    verdict: str
    error_m: float = None


def outcome_of(program, pair, folder):
    """Writes the clouds of a pair and registers them."""
    os.makedirs(folder, exist_ok=True)
    files = [f"{folder}/target.ply", f"{folder}/source.ply"]
    for file, cloud in zip(files, (pair.target, pair.source)):
        laser_scans.write(file, cloud.points)
    subprocess.run([program, "register", *files, "--out", f"{folder}/out", "--quiet"],
                   check=False, stderr=subprocess.DEVNULL)
    with open(f"{folder}/out/report.json", encoding="utf-8") as file:
        verdict = json.load(file)["pairs"][0]["verdict"]
    with open(f"{folder}/out/transforms.json", encoding="utf-8") as file:
        found = json.load(file)["clouds"][1]["transform"]
    if found is None:
        return Outcome(verdict)
    return Outcome(verdict, pair.error_m(numpy.reshape(found, (4, 4))))


def score(program, pairs, folder):
    """Prints a row for each pair. Returns the numbers of wrong, placed and possible ones."""
    wrong = placed = 0
    for index, pair in enumerate(pairs):
        found = outcome_of(program, pair, f"{folder}/{index}")
        is_right = (found.error_m is not None and pair.is_possible
                    and found.error_m <= RIGHT_WITHIN_M)
        placed += is_right
        wrong += found.error_m is not None and not is_right
        error = "" if found.error_m is None else f"{100 * found.error_m:.1f} cm"
        print(f"| {pair.name} | {'yes' if pair.is_possible else 'no'} | {found.verdict} "
              f"| {error} |", flush=True)
    return wrong, placed, sum(pair.is_possible for pair in pairs)


def parsed():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build")
    parser.add_argument("--clouds", help="folder with clouds of others")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--keep", help="folder in which clouds and results are kept")
    return parser.parse_args()


def main():
    arguments = parsed()
    program = f"{arguments.build}/apps/tofmap"
    total = numpy.zeros(3, dtype=int)
    with tempfile.TemporaryDirectory() as temporary:
        for seed in arguments.seeds:
            here = Surveyor(seed)
            pairs = possible_pairs(seed, here) + impossible_pairs(seed, here)
            if arguments.clouds:
                pairs += real_pairs(arguments.clouds, here)
            print(f"\nSeed {seed}:\n\n| pair | possible | outcome | error |\n|---|---|---|---|")
            folder = f"{arguments.keep or temporary}/seed_{seed}"
            total += score(program, pairs, folder)
    wrong, placed, possible = total
    print(f"\nWrong answers: {wrong}. Placed of the possible: {placed} of {possible} "
          f"({100 * placed / possible:.0f} %).")


if __name__ == "__main__":
    main()

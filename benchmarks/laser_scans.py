# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Simulated buildings, and what a turning laser scanner records of them.

A building is a corridor with rooms on both sides. Doors stand open; outer walls have windows, whose
panes a scanner sees or sees through; rooms are furnished. Storeys of a building have the same walls
and other furniture. Needs Debian's python3-vtk9 and python3-numpy.
"""
import dataclasses

import numpy
import vtk
from vtk.util import numpy_support

WALL_M = 0.12


class Boxes:
    """A mesh of boxes."""

    def __init__(self):
        self.corners, self.faces = [], []

    def add(self, low, high, turn_rad=0.0):
        """A box from corner to corner, turned about its vertical middle axis."""
        low, high = numpy.minimum(low, high), numpy.maximum(low, high)
        unit = numpy.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
        corners = low + unit * (high - low)
        middle = 0.5 * (low + high)
        cos, sin = numpy.cos(turn_rad), numpy.sin(turn_rad)
        turn = numpy.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
        sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        start = 8 * len(self.corners)
        for a, b, c, d in sides:
            self.faces += [(start + a, start + b, start + c), (start + a, start + c, start + d)]
        self.corners.append((corners - middle) @ turn.T + middle)

    def mesh(self):
        faces = numpy.array(self.faces, dtype=numpy.int64).reshape(-1, 3)
        points = vtk.vtkPoints()
        points.SetData(numpy_support.numpy_to_vtk(numpy.concatenate(self.corners), deep=True))
        cells = vtk.vtkCellArray()
        cells.SetData(3, numpy_support.numpy_to_vtkIdTypeArray(faces.ravel(), deep=True))
        mesh = vtk.vtkPolyData()
        mesh.SetPoints(points)
        mesh.SetPolys(cells)
        return mesh


@dataclasses.dataclass
class Scene:
    """Surfaces, panes of glass, and the middles of the rooms (at the height of a scanner)."""
    solid: vtk.vtkPolyData
    glass: vtk.vtkPolyData  # None if there are no panes
    rooms: list
    corridor: list

    def clearance_m(self, place):
        """How far the nearest surface is from a place."""
        locator = vtk.vtkStaticCellLocator()
        locator.SetDataSet(self.solid)
        locator.BuildLocator()
        nearest, squared_m = [0.0, 0.0, 0.0], vtk.reference(0.0)
        locator.FindClosestPoint(place, nearest, vtk.reference(0), vtk.reference(0), squared_m)
        return numpy.sqrt(float(squared_m))


@dataclasses.dataclass
class Opening:
    """A door or a window in a wall: along the wall, then upwards, metres."""
    start: float
    end: float
    bottom: float
    top: float
    has_pane: bool = False

    def beyond(self, place):
        """The same opening, farther along the wall."""
        return dataclasses.replace(self, start=self.start + place, end=self.end + place)


class Builder:
    """Builds a storey. `plan` determines walls, doors and windows; `furniture` what stands there."""

    def __init__(self, plan, furniture):
        self.plan = numpy.random.default_rng(plan)
        self.furniture = numpy.random.default_rng([plan, furniture])
        self.solid, self.glass = Boxes(), Boxes()
        self.height = self.plan.uniform(2.6, 3.2)

    def wall(self, along_x, at, start, end, openings):
        """A wall along x or y at a place of the other axis, with openings."""
        def piece(boxes, first, last, bottom, top, thick=WALL_M):
            if last - first < 1e-6 or top - bottom < 1e-6:
                return
            low, high = [first, at - thick / 2, bottom], [last, at + thick / 2, top]
            if not along_x:
                low[:2], high[:2] = low[1::-1], high[1::-1]
            boxes.add(numpy.array(low), numpy.array(high))
        place = start
        for gap in sorted(openings, key=lambda gap: gap.start):
            piece(self.solid, place, gap.start, 0, self.height)
            piece(self.solid, gap.start, gap.end, 0, gap.bottom)
            piece(self.solid, gap.start, gap.end, gap.top, self.height)
            if gap.has_pane:
                self.frame(piece, gap)
            place = gap.end
        piece(self.solid, place, end, 0, self.height)

    def frame(self, piece, gap):
        """The pane of a window and its frame, with a bar in the middle."""
        bar = 0.06
        piece(self.glass, gap.start, gap.end, gap.bottom, gap.top, 0.02)
        middle = 0.5 * (gap.start + gap.end)
        for first in (gap.start, middle - bar / 2, gap.end - bar):
            piece(self.solid, first, first + bar, gap.bottom, gap.top, bar)
        for bottom in (gap.bottom, gap.top - bar):
            piece(self.solid, gap.start, gap.end, bottom, bottom + bar, bar)

    def door(self, length):
        """A door in the inner wall of a room of some length."""
        start = self.plan.uniform(0.4, length - 1.4)
        return Opening(start, start + 0.95, 0, 2.05)

    def windows(self, length):
        """One or two windows in the outer wall of a room of some length."""
        count = self.plan.integers(1, 3)
        width = self.plan.uniform(1.0, 1.6)
        sill, top = self.plan.uniform(0.8, 1.0), self.height - self.plan.uniform(0.4, 0.6)
        middles = length * (numpy.arange(count) + 0.5) / count
        return [Opening(m - width / 2, m + width / 2, sill, top, True) for m in middles]

    def furnish(self, low, high):
        """Cupboards along the walls, tables and boxes in a room."""
        low, high, random = numpy.array(low), numpy.array(high), self.furniture
        for _ in range(random.integers(2, 5)):
            size = numpy.array([random.uniform(0.4, 1.6), random.uniform(0.3, 0.6),
                                random.uniform(0.7, 2.1)])
            if random.random() < 0.5:
                size[:2] = size[1::-1]
            corner = numpy.append(random.uniform(low, high - size[:2]), 0)
            side = random.integers(4)
            edge = low[side // 2] if side % 2 else high[side // 2] - size[side // 2]
            corner[side // 2] = edge + (0.07 if side % 2 else -0.07)
            self.solid.add(corner, corner + size)
        for _ in range(random.integers(1, 4)):
            self.table(random.uniform(low + 0.9, high - 0.9))
        for _ in range(random.integers(2, 6)):
            size = random.uniform(0.2, 0.6, 3)
            corner = numpy.append(random.uniform(low + 0.4, high - 0.8), 0)
            self.solid.add(corner, corner + size, random.uniform(0, 1.5))

    def table(self, at):
        random = self.furniture
        half = numpy.array([random.uniform(0.4, 0.8), random.uniform(0.3, 0.5)])
        top = random.uniform(0.65, 0.8)
        self.solid.add(numpy.append(at - half, top - 0.04), numpy.append(at + half, top))
        for sign in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
            leg = at + numpy.array(sign) * (half - 0.05)
            self.solid.add(numpy.append(leg - 0.03, 0), numpy.append(leg + 0.03, top - 0.04))

    def surroundings(self, low, high):
        """Ground, and houses at some distance, which windows show."""
        self.solid.add(numpy.array([low[0] - 40, low[1] - 40, -3.2]),
                       numpy.array([high[0] + 40, high[1] + 40, -3.0]))
        for side in range(4):
            for place in numpy.arange(low[side // 2 ^ 1] - 5, high[side // 2 ^ 1] + 5, 9):
                away = self.plan.uniform(8, 20)
                size = self.plan.uniform([4, 4, 2], [8, 7, 9])
                corner = numpy.zeros(3)
                corner[side // 2 ^ 1] = place
                corner[side // 2] = (low[side // 2] - away - size[side // 2] if side % 2
                                     else high[side // 2] + away)
                corner[2] = -3
                self.solid.add(corner, corner + size, self.plan.uniform(-0.3, 0.3))


def building(plan, storey=0, twins=False, has_ceiling=True, rooms=3):
    """A storey with `rooms` rooms on each side of a corridor along x. With `twins`, all rooms of a
    side have the same size, windows and door. Without a ceiling, they are courts."""
    build = Builder(plan, storey)
    width = build.plan.uniform(2.0, 2.6)
    depths = build.plan.uniform(4.0, 6.0, 2)
    lengths = build.plan.uniform(3.8, 6.0, rooms)
    if twins:
        lengths[:] = lengths[0]
    edges = numpy.concatenate([[0], numpy.cumsum(lengths)])
    inner = {1: width / 2, -1: -width / 2}
    outer = {1: width / 2 + depths[0], -1: -width / 2 - depths[1]}
    low, high = numpy.array([0, outer[-1]]), numpy.array([edges[-1], outer[1]])
    for bottom in (-0.2, build.height) if has_ceiling else (-0.2,):
        build.solid.add(numpy.append(low, bottom), numpy.append(high, bottom + 0.2))
    middles = []
    for side in (1, -1):
        panes, doors = [], []
        for first, last in zip(edges, edges[1:]):
            if first == 0 or not twins:
                room_panes, room_door = build.windows(last - first), build.door(last - first)
            panes += [pane.beyond(first) for pane in room_panes]
            doors.append(room_door.beyond(first))
            build.furnish([first, min(inner[side], outer[side])],
                          [last, max(inner[side], outer[side])])
            middles.append(numpy.array([(first + last) / 2, (inner[side] + outer[side]) / 2, 1.5]))
        build.wall(True, outer[side], 0, edges[-1], panes)
        build.wall(True, inner[side], 0, edges[-1], doors)
        for edge in edges:
            build.wall(False, edge, *sorted([inner[side], outer[side]]), [])
    for edge in (edges[0], edges[-1]):
        middle = [Opening(-0.5, 0.5, 0.9, build.height - 0.5, True)]
        build.wall(False, edge, -width / 2, width / 2, middle)
    build.surroundings(low, high)
    corridor = [numpy.array([share * edges[-1], 0, 1.5]) for share in (0.2, 0.5, 0.8)]
    return Scene(build.solid.mesh(), build.glass.mesh(), middles, corridor)


@dataclasses.dataclass
class Scanner:
    """A scanner that turns about its vertical axis."""
    step_deg: float = 0.7
    lowest_deg: float = -60
    highest_deg: float = 75
    limit_m: float = 30
    noise_m: float = 0.006
    noise_per_m: float = 0.0005
    keeps_limit: bool = False  # rays without a return become points at the limit
    sees_panes: float = 0.0    # share of the panes that return the ray, as dirty ones or blinds do

    def rays(self):
        azimuth = numpy.radians(numpy.arange(0, 360, self.step_deg))
        elevation = numpy.radians(numpy.arange(self.lowest_deg, self.highest_deg, self.step_deg))
        a, e = (grid.ravel() for grid in numpy.meshgrid(azimuth, elevation))
        return numpy.stack([numpy.cos(e) * numpy.cos(a), numpy.cos(e) * numpy.sin(a),
                            numpy.sin(e)], axis=1)


def cast(mesh, origin, rays, reach_m):
    """Ranges and hit triangles; infinite and -1 where a ray hits nothing within reach."""
    ranges_m, triangles = numpy.full(len(rays), numpy.inf), numpy.full(len(rays), -1)
    if mesh is None:
        return ranges_m, triangles
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(mesh)
    locator.BuildLocator()
    share, part, cell = vtk.reference(0.0), vtk.reference(0), vtk.reference(0)
    place, inside = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
    for i, end in enumerate(origin + reach_m * rays):
        if locator.IntersectWithLine(origin, end, 1e-9, share, place, inside, part, cell):
            ranges_m[i], triangles[i] = reach_m * float(share), int(cell)
    return ranges_m, triangles


def scan(scene, pose, scanner, seed):
    """The points of a scan in the frame of the scanner, whose pose in the scene is 4x4."""
    random = numpy.random.default_rng(seed)
    local = scanner.rays()
    rays = local @ pose[:3, :3].T
    range_m, _ = cast(scene.solid, pose[:3, 3], rays, scanner.limit_m)
    pane_m, triangle = cast(scene.glass, pose[:3, 3], rays, scanner.limit_m)
    panes = scene.glass.GetNumberOfCells() // 12 if scene.glass else 1  # boxes of 12 triangles
    is_seen = random.random(panes) < scanner.sees_panes
    range_m = numpy.where((pane_m < range_m) & is_seen[triangle // 12], pane_m, range_m)
    has_return = numpy.isfinite(range_m)
    noise_m = scanner.noise_m + scanner.noise_per_m * numpy.where(has_return, range_m, 0)
    noisy = numpy.where(has_return, range_m, 0) + noise_m * random.normal(size=len(local))
    points = numpy.where(has_return, noisy, scanner.limit_m)[:, None] * local
    return points if scanner.keeps_limit else points[has_return]


def standing(at, heading_deg, tilt_deg=0.0):
    """The pose of a scanner."""
    a, t = numpy.radians([heading_deg, tilt_deg])
    turn = numpy.array([[numpy.cos(a), -numpy.sin(a), 0], [numpy.sin(a), numpy.cos(a), 0],
                        [0, 0, 1]])
    tilt = numpy.array([[1, 0, 0], [0, numpy.cos(t), -numpy.sin(t)],
                        [0, numpy.sin(t), numpy.cos(t)]])
    pose = numpy.eye(4)
    pose[:3, :3], pose[:3, 3] = turn @ tilt, at
    return pose


def write(file, points):
    with open(file, "wb") as out:
        out.write(("ply\nformat binary_little_endian 1.0\n"
                   f"element vertex {len(points)}\nproperty float x\nproperty float y\n"
                   "property float z\nend_header\n").encode() + points.astype("<f4").tobytes())

# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Buildings made of boxes, as meshes that `tofmap simulate` reads."""
import numpy

WALL_M = 0.12  # thickness of walls, floors and ceilings
WALL, FLOOR, CEILING, DOOR, WOOD, METAL, CLOTH = 0.62, 0.35, 0.75, 0.45, 0.4, 0.55, 0.25

# The corners of a box, as signs of its half sizes, and its faces, seen from outside.
CORNERS = numpy.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)])
FACES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


class Building:
    """Boxes in a world with z up, in metres. Each has its own reflectance."""

    def __init__(self):
        self.centres, self.halves, self.yaws, self.reflectances = [], [], [], []

    def box(self, low, high, reflectance, yaw_deg=0):
        """Adds a box between two corners, rotated about its own vertical axis."""
        low, high = numpy.asarray(low, float), numpy.asarray(high, float)
        self.centres.append((low + high) / 2)
        self.halves.append((high - low) / 2)
        self.yaws.append(numpy.radians(yaw_deg))
        self.reflectances.append(reflectance)

    def slab(self, low, high, top_m, reflectance=FLOOR):
        """Adds a horizontal slab below `top_m`: a floor, or a ceiling seen from below."""
        self.box([*low, top_m - WALL_M], [*high, top_m], reflectance)

    def column(self, x, y, low_m, high_m, reflectance=WALL):
        """Adds a column of 0.26 m x 0.26 m, askew: its faces constrain motion along both axes."""
        self.box([x - 0.13, y - 0.13, low_m], [x + 0.13, y + 0.13, high_m], reflectance, 45)

    def wall(self, start, end, bottom_m, top_m, doors=(), reflectance=WALL):
        """Adds a wall along x or y from `start` to `end`, with a gap for each door. A door is its
        begin and end along the wall and its height, in metres."""
        start, end = numpy.asarray(start, float), numpy.asarray(end, float)
        length_m = numpy.linalg.norm(end - start)
        along = (end - start) / length_m
        begin_m = -WALL_M / 2

        def piece(begin_m, end_m, low_m, high_m):
            corners = numpy.array([start + begin_m * along, start + end_m * along])
            margin = WALL_M / 2 * (1 - numpy.abs(along))
            self.box([*(corners.min(axis=0) - margin), low_m],
                     [*(corners.max(axis=0) + margin), high_m], reflectance)

        for door_begin_m, door_end_m, height_m in sorted(doors):
            piece(begin_m, door_begin_m, bottom_m, top_m)
            piece(door_begin_m, door_end_m, bottom_m + height_m, top_m)
            begin_m = door_end_m
        piece(begin_m, length_m + WALL_M / 2, bottom_m, top_m)

    def add(self, other, offset, yaw_deg=0):
        """Adds all boxes of another building, rotated about its origin and moved by `offset`."""
        yaw = numpy.radians(yaw_deg)
        cos, sin = numpy.cos(yaw), numpy.sin(yaw)
        rotation = numpy.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
        self.centres += [rotation @ centre + offset for centre in other.centres]
        self.halves += other.halves
        self.yaws += [yaw + other_yaw for other_yaw in other.yaws]
        self.reflectances += other.reflectances

    def clearance_m(self, points):
        """The distance of each point from the nearest box; 0 inside of a box."""
        nearest = numpy.full(len(points), numpy.inf)
        for centre, half, yaw in zip(self.centres, self.halves, self.yaws):
            x, y, z = (numpy.asarray(points) - centre).T
            cos, sin = numpy.cos(yaw), numpy.sin(yaw)
            local = numpy.column_stack([cos * x + sin * y, cos * y - sin * x, z])
            outside = numpy.maximum(numpy.abs(local) - half, 0)
            nearest = numpy.minimum(nearest, numpy.linalg.norm(outside, axis=1))
        return nearest

    def corners(self, index):
        """The eight corners of a box."""
        cos, sin = numpy.cos(self.yaws[index]), numpy.sin(self.yaws[index])
        x, y, z = (CORNERS * self.halves[index]).T
        return self.centres[index] + numpy.column_stack([cos * x - sin * y, sin * x + cos * y, z])

    def write_ply(self, file):
        """Writes the boxes as a mesh. A vertex is as grey as its box reflects."""
        lines = []
        for index, reflectance in enumerate(self.reflectances):
            grey = f" {round(255 * reflectance)}" * 3
            lines += [f"{x:.4f} {y:.4f} {z:.4f}{grey}" for x, y, z in self.corners(index)]
        faces = ["4 " + " ".join(str(8 * index + corner) for corner in face)
                 for index in range(len(self.centres)) for face in FACES]
        header = ["ply", "format ascii 1.0", f"element vertex {len(lines)}", "property float x",
                  "property float y", "property float z", "property uchar red",
                  "property uchar green", "property uchar blue", f"element face {len(faces)}",
                  "property list uchar int vertex_indices", "end_header"]
        file.write_text("\n".join(header + lines + faces) + "\n", encoding="utf-8")

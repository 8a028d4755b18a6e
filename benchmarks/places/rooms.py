# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Furnished rooms, corridors and stairs."""
from places.building import CEILING, CLOTH, METAL, WALL, WALL_M, WOOD, Building

DOOR_M = 2.05  # height of doors


def chair():
    """A seat on a block, with a back."""
    made = Building()
    made.box([-0.22, -0.22, 0], [0.22, 0.22, 0.45], CLOTH)
    made.box([-0.22, 0.16, 0.45], [0.22, 0.22, 0.95], CLOTH)
    return made


def table(made, low, high):
    """Adds a table between two corners on the floor."""
    (x0, y0), (x1, y1) = low, high
    made.box([x0, y0, 0.70], [x1, y1, 0.75], WOOD)
    for x in (x0 + 0.05, x1 - 0.1):
        for y in (y0 + 0.05, y1 - 0.1):
            made.box([x, y, 0], [x + 0.05, y + 0.05, 0.70], WOOD)


class Room:
    """The plan of a furnished room [0, width] x [0, depth] with a door in the wall y = 0. Its
    middle is free."""

    def __init__(self, random, width_m=None, depth_m=None, height_m=None):
        self.width_m = width_m or random.uniform(3.8, 4.8)
        self.depth_m = depth_m or random.uniform(3.6, 4.4)
        self.height_m = height_m or random.uniform(2.5, 2.8)
        self.door_m = random.uniform(0.35, 0.65) * self.width_m  # its middle
        self.furniture = self.furnish(random)

    def furnish(self, random):
        """A cabinet, a table and a shelf along the walls, and a beam."""
        made = Building()
        width_m, depth_m = self.width_m, self.depth_m
        cabinet_m = random.uniform(0.9, 1.4)
        made.box([0, depth_m - 0.45, 0], [cabinet_m, depth_m, random.uniform(1.6, 2.1)], WOOD)
        left = random.uniform(0.3, 0.8) + cabinet_m
        table(made, [left, depth_m - 0.7], [min(left + 1.3, width_m - 0.5), depth_m])
        made.box([left + 0.2, depth_m - 0.45, 0.75], [left + 0.65, depth_m - 0.25, 1.15], METAL)
        begin_m = random.uniform(0.8, depth_m - 2.2)
        made.box([width_m - 0.35, begin_m, 0], [width_m, begin_m + 1.1, random.uniform(0.8, 1.3)],
                 WOOD)
        begin_m = random.uniform(0.6, 1.2)
        made.box([0, begin_m, 0], [0.4, begin_m + 0.8, random.uniform(0.5, 0.9)], CLOTH)
        beam_m = random.uniform(0.4, 0.6) * depth_m
        made.box([0, beam_m, self.height_m - 0.25], [width_m, beam_m + 0.25, self.height_m], WALL)
        return made

    def build(self, building, origin):
        """Adds the room without the wall of its door."""
        shell = Building()
        shell.slab([0, 0], [self.width_m, self.depth_m], 0)
        shell.slab([0, 0], [self.width_m, self.depth_m], self.height_m + WALL_M, CEILING)
        half_m = WALL_M / 2
        right_m, back_m = self.width_m + half_m, self.depth_m + half_m
        shell.wall([-half_m, 0], [-half_m, back_m], 0, self.height_m)
        shell.wall([right_m, 0], [right_m, back_m], 0, self.height_m)
        shell.wall([-half_m, back_m], [right_m, back_m], 0, self.height_m)
        building.add(shell, origin)
        building.add(self.furniture, origin)

    def add_columns(self, building, origin):
        """Adds a column to three of its walls, for walks that look at them."""
        made = Building()
        for x, y in ((0, self.depth_m - 0.9), (self.width_m, self.depth_m - 0.95),
                     (self.width_m, 0.35)):
            made.column(x, y, 0, self.height_m)
        building.add(made, origin)

    def door(self, x, width_m=0.95):
        """The door of a room at `x`, for Building.wall()."""
        return (x + self.door_m - width_m / 2, x + self.door_m + width_m / 2, DOOR_M)


def corridor(building, length_m, width_m, height_m, doors):
    """Adds a corridor [0, length] x [-width, 0] with doors in its wall y = 0."""
    half_m = WALL_M / 2
    building.slab([0, -width_m], [length_m, 0], 0)
    building.slab([0, -width_m], [length_m, 0], height_m + WALL_M, CEILING)
    building.wall([0, half_m - WALL_M], [length_m, half_m - WALL_M], 0, height_m, doors)
    building.wall([0, -width_m - half_m], [length_m, -width_m - half_m], 0, height_m)
    for x in (-half_m, length_m + half_m):
        building.wall([x, -width_m - half_m], [x, 0], 0, height_m)

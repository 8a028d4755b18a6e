# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Halls that repeat one piece of furniture, and a ring of corridors, and walks through them."""
from places.building import CEILING, CLOTH, DOOR, METAL, WALL, WALL_M, WOOD, Building
from places.rooms import chair, table
from places.walk import Walk


def hall(width_m, depth_m, height_m):
    """A building of four walls, floor and ceiling: [0, width] x [0, depth] inside."""
    building = Building()
    half_m = WALL_M / 2
    right, back = width_m + half_m, depth_m + half_m
    building.slab([0, 0], [width_m, depth_m], 0)
    building.slab([0, 0], [width_m, depth_m], height_m + WALL_M, CEILING)
    for start, end in (([-half_m, -half_m], [right, -half_m]), ([-half_m, back], [right, back]),
                       ([-half_m, -half_m], [-half_m, back]), ([right, -half_m], [right, back])):
        building.wall(start, end, 0, height_m)
    return building


def columns(building, size_m, xs, ys):
    """Adds equal columns to the walls of a hall: at `xs` to those along x, at `ys` to those along
    y."""
    width_m, depth_m, height_m = size_m
    places = [(x, y) for x in xs for y in (0, depth_m)] + [(x, y) for x in (0, width_m) for y in ys]
    for x, y in places:
        building.column(x, y, 0, height_m)


def bay(random, depth_m):
    """A bay of a rack along y with the same crates on each of its boards, and its length."""
    made = Building()
    length_m = random.uniform(1.2, 1.4)
    for board_m in (0.15, 0.85, 1.55, 2.25):
        made.box([0, 0, board_m], [depth_m, length_m, board_m + 0.04], METAL)
    for x in (0, depth_m - 0.06):
        made.box([x, 0, 0], [x + 0.06, 0.06, 2.4], METAL)
    for board_m in (0.19, 0.89, 1.59):
        begin_m = 0.1
        while begin_m < length_m - 0.4:
            end_m = min(begin_m + random.uniform(0.25, 0.5), length_m - 0.02)
            made.box([0.08, begin_m, board_m],
                     [depth_m - 0.08, end_m, board_m + random.uniform(0.25, 0.5)], WOOD)
            begin_m = end_m + random.uniform(0.05, 0.12)
    return made, length_m


def shelves(random, differs):
    """Three aisles between racks of equal bays with equal crates. The camera goes up the first,
    down the second, up the third, and once more into the second."""
    depth_m, aisle_m, cross_m = 0.7, random.uniform(1.6, 1.9), random.uniform(1.7, 2.0)
    made, length_m = bay(random, depth_m)
    pitch_m = depth_m + aisle_m
    inner_m = 4 * length_m
    size_m = [3 * pitch_m + depth_m, inner_m + 2 * cross_m, random.uniform(3.2, 3.8)]
    building = hall(*size_m)
    columns(building, size_m, [depth_m / 2 + i * pitch_m / 2 for i in range(7)],
              [0.4 * cross_m, size_m[1] - 0.4 * cross_m])
    for rack in range(4):
        for i in range(4):
            building.add(made, [rack * pitch_m, cross_m + i * length_m, 0])
    if differs:
        building.box([pitch_m + depth_m, cross_m + 2.2, 0],
                     [pitch_m + depth_m + 0.4, cross_m + 2.6, 0.5], CLOTH)
    aisles = [depth_m + aisle_m / 2 + i * pitch_m + (0.1 if differs else 0) for i in range(3)]
    low, high = 0.5 * cross_m, 1.5 * cross_m + inner_m
    walk = Walk([aisles[0], low], 90)
    for aisle, y, yaw_deg in ((0, high, 0), (1, high, -90), (1, low, 0), (2, low, 90),
                              (2, high, 180), (1, high, 270)):
        walk.corner(aisles[aisle], y, yaw_deg)
    return building, [walk.go(aisles[1], high - 2.5)]


def ring(random, differs):
    """Four equal corridors around a square block, with equal doors. The camera goes round once and
    a quarter, so only the last quarter is a place seen before."""
    block_m, width_m = random.uniform(4.4, 5.0), random.uniform(1.6, 1.8)
    outer_m = block_m + 2 * width_m
    height_m = random.uniform(2.4, 2.7)
    building = hall(outer_m, outer_m, height_m)
    low, high = width_m + WALL_M / 2, outer_m - width_m - WALL_M / 2
    at = [0.5 * (high - low) + shift for shift in (-1.1, 1.1)]
    doors = [(place - 0.45, place + 0.45, 2.05) for place in at]
    for start, end in (([low, low], [high, low]), ([low, high], [high, high]),
                       ([low, low], [low, high]), ([high, low], [high, high])):
        building.wall(start, end, 0, height_m, doors)
    inner = (low + WALL_M / 2, high - WALL_M / 2)  # the leaves of the doors, behind the walls
    building.box([inner[0], inner[0], 0], [inner[1], inner[1], 2.1], DOOR)
    middle_m = outer_m / 2
    places = [0.35 * width_m, middle_m, outer_m - 0.35 * width_m]
    columns(building, [outer_m, outer_m, height_m], places, places)
    if differs:
        building.add(chair(), [outer_m - 0.35, middle_m + 1.2, 0], -90)
    near, far = width_m / 2, outer_m - width_m / 2
    walk = Walk([near + 0.3, near], 0)
    walk.corner(far, near, 90).corner(far, far, 180).corner(near, far, 270).corner(near, near, 360)
    return building, [walk.go(far - 0.3, near)]


def pillar_hall(random, differs):
    """A long hall with two rows of equal pillars at equal distances. The camera goes along its
    middle, comes back behind a row, and looks along the middle again."""
    pitch_m, count = random.uniform(2.5, 2.9), 5
    length_m, width_m = pitch_m * (count + 1), random.uniform(6.5, 7.2)
    height_m = random.uniform(3.0, 3.6)
    building = hall(length_m, width_m, height_m)
    rows = [width_m * share for share in (0.31, 0.69)]
    along = [pitch_m * (i + 1) for i in range(count)]
    columns(building, [length_m, width_m, height_m], along, [rows[0], width_m / 2, rows[1]])
    for x in along:
        for y in rows:
            building.box([x - 0.2, y - 0.2, 0], [x + 0.2, y + 0.2, height_m], WALL)
    if differs:
        building.add(chair(), [2.5 * pitch_m, rows[1] + 0.1, 0], 200)
    middle_m, side_m = width_m / 2, 0.16 * width_m
    walk = Walk([1.3, middle_m], 0)
    walk.corner(length_m - 1.3, middle_m, -90).corner(length_m - 1.3, side_m, -180)
    walk.corner(1.3, side_m, -270).corner(1.3, middle_m, -360)
    return building, [walk.go(3, middle_m)]


def cubicle(random, depth_m, width_m):
    """A desk with a screen along the wall y = depth, a cabinet and a chair."""
    made = Building()
    table(made, [0.1, depth_m - 0.75], [width_m - 0.1, depth_m - 0.05])
    middle_m = random.uniform(0.4, 0.6) * width_m
    made.box([middle_m - 0.3, depth_m - 0.3, 0.85], [middle_m + 0.3, depth_m - 0.25, 1.2], METAL)
    made.box([0.1, depth_m - 1.5, 0], [0.5, depth_m - 1.0, 0.6], METAL)
    made.add(chair(), [middle_m, depth_m - 1.2, 0], random.uniform(150, 210))
    return made


def cubicles(random, differs):
    """An office with an aisle between two rows of five equal cubicles. The camera looks into those
    on its left on the way there and on the way back, and into the first ones again."""
    width_m, depth_m, aisle_m = random.uniform(1.9, 2.2), random.uniform(2.0, 2.3), 1.6
    length_m = 5 * width_m + 1.6
    building = hall(length_m, 2 * depth_m + aisle_m, 2.7)
    made = cubicle(random, depth_m, width_m)
    top_m = random.uniform(1.55, 1.7)
    for i in range(6):
        x = 0.8 + i * width_m
        for y in (0, depth_m + aisle_m):
            building.box([x - 0.03, y, 0], [x + 0.03, y + depth_m, top_m], CLOTH)
    for i in range(5):
        building.add(made, [0.8 + i * width_m, depth_m + aisle_m, 0])
        building.add(made, [0.8 + (i + 1) * width_m, depth_m, 0], 180)
    if differs:
        building.box([0.8 + 3.7 * width_m, depth_m + aisle_m + 0.3, 0],
                     [0.8 + 3.7 * width_m + 0.3, depth_m + aisle_m + 0.7, 0.5], WOOD)
    middle_m = depth_m + aisle_m / 2
    walk = Walk([1.2, middle_m], 65, pitch_deg=-10)
    walk.go(length_m - 1.2, middle_m).turn(245).go(1.2, middle_m)
    return building, [walk.turn(425).go(1.2 + 1.6 * width_m, middle_m)]

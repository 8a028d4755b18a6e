# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rooms of one plan side by side, and walks through them."""
from places.building import CLOTH, METAL, WOOD, Building
from places.rooms import Room, chair, corridor
from places.walk import Walk


def twins(random, differs):
    """Two rooms of one plan along a corridor, and their offsets along it."""
    room = Room(random)
    width_m = random.uniform(1.8, 2.1)
    offsets = [0.5, 0.5 + room.width_m + random.uniform(0.2, 0.8)]
    length_m = offsets[1] + room.width_m + random.uniform(0.4, 1)
    building = Building()
    for x in offsets:
        room.build(building, [x, 0, 0])
    corridor(building, length_m, width_m, room.height_m, [room.door(x) for x in offsets])
    building.box([length_m - 0.35, -0.9, 0], [length_m, -0.2, random.uniform(0.9, 1.4)], WOOD)
    for x in offsets:  # a radiator and a board, so that the wall opposite a door is not bare
        door, wall = x + room.door_m, -width_m
        building.box([door - 0.5, wall, 0.15], [door + 0.5, wall + 0.12, 0.75], METAL)
        building.box([door + 0.1, wall, 1.2], [door + 0.9, wall + 0.06, 1.8], CLOTH)
    if differs:
        building.add(chair(), [offsets[1] + room.width_m - 0.75, 0.6, 0], 140)
    return building, room, offsets, width_m


def twin_rooms(random, differs):
    """One twin, the other, and the first again, by way of the corridor."""
    building, room, (first, second), width_m = twins(random, differs)
    middle_m, aisle = 0.45 * room.depth_m, -0.5 * width_m
    one, two = first + room.door_m, second + room.door_m
    for x, door in ((first, one), (second, two)):
        room.add_columns(building, [x, 0, 0])
        # A sideboard opposite the door, and two boxes on it, askew.
        building.box([door - 0.7, -width_m, 0], [door + 0.7, 0.3 - width_m, 0.85], WOOD)
        for shift in (-0.4, 0.4):
            building.column(door + shift, 0.15 - width_m, 0.85, 1.3, CLOTH)
    walk = Walk([one, middle_m], 150)
    walk.turn(30, -90).corner(one, aisle, 0, 0.7).corner(two, aisle, 90, 0.7).go(two, middle_m)
    walk.turn(145, 40, -90).corner(two, aisle, -180, 0.7).corner(one, aisle, -270, 0.7)
    return building, [walk.go(one, middle_m).turn(-230, -300)]


def twin_rooms_bare(random, differs):
    """The same walk without columns and with turns on the spot, some of them before walls that are
    nearly bare, so that little is known about the path."""
    building, room, (first, second), width_m = twins(random, differs)
    middle_m, aisle = 0.45 * room.depth_m, -0.5 * width_m
    one, two = first + room.door_m, second + room.door_m
    walk = Walk([one, middle_m], 150)
    walk.turn(30, -90).go(one, aisle).turn(0).go(two, aisle).turn(90).go(two, middle_m)
    walk.turn(145, 40, -90).go(two, aisle).turn(-180).go(one, aisle).turn(-270)
    return building, [walk.go(one, middle_m).turn(-230, -300)]


def row_of_rooms(random, differs, stretches_m):
    """Five rooms of one plan along a corridor, with a bare wall more between two of them, of a
    length in the range `stretches_m`. Also the places of their doors along x, and of the path along
    the corridor in y."""
    room = Room(random, width_m=random.uniform(3.0, 3.3), depth_m=random.uniform(3.2, 3.8))
    width_m = random.uniform(2.0, 2.3)
    pitch_m = room.width_m + 0.12
    stretch_m = random.uniform(*stretches_m)
    long_after = random.integers(2, 4)
    offsets = [0.6 + pitch_m * i + (stretch_m if i > long_after else 0) for i in range(5)]
    building = Building()
    for x in offsets:
        room.build(building, [x, 0, 0])
    corridor(building, offsets[-1] + room.width_m + 0.6, width_m, room.height_m,
             [room.door(x) for x in offsets])
    if differs:
        building.add(chair(), [offsets[3] + room.width_m - 0.7, 0.7, 0], 140)
    return building, [x + room.door_m for x in offsets], -width_m + 0.75


def five_rooms(random, differs):
    """Five rooms of one plan in a row. The camera looks at the wall with the doors all the time,
    which is bare between the doors. It enters each room by a step or two, and comes back along the
    corridor."""
    building, doors, aisle = row_of_rooms(random, differs, (2.2, 3.0))
    walk = Walk([doors[0], aisle], 90, pitch_deg=-14)
    for door in doors:
        walk.go(door, aisle).go(door, 0.6).turn(108, 72, 90).go(door, aisle)
    for door in doors[3:1:-1]:
        walk.go(door, aisle)
    return building, [walk]


def five_rooms_once(random, differs):
    """Five rooms of one plan in a row. The camera looks ahead between the doors, but once at the
    bare wall between two of them. It enters each room by a step, and looks into the last four again
    on the way back."""
    building, doors, aisle = row_of_rooms(random, differs, (0, 0.3))
    bare = random.integers(1, 4)
    walk = Walk([doors[0], aisle], 90, pitch_deg=-10)
    for i, door in enumerate(doors):
        if i > 0 and i != bare:
            walk.go(doors[i - 1] + 0.8, aisle, yaw_deg=40).go(door - 0.8, aisle)
        walk.go(door, aisle, yaw_deg=90).go(door, 0.4).go(door, aisle)
    for door in doors[3:0:-1]:
        walk.go(door + 2.4, aisle, yaw_deg=125).go(door + 0.7, aisle)
        walk.go(door, aisle, yaw_deg=90)
    return building, [walk]


def carried_to_twin(random, differs):
    """A look around in one twin, and, without the way there, in the other. What differs comes into
    view last."""
    building, room, offsets, _ = twins(random, differs)
    middle_m = 0.45 * room.depth_m
    walks = []
    for x in offsets:
        door = x + room.door_m + random.uniform(-0.2, 0.2)
        walk = Walk([door, middle_m + random.uniform(-0.2, 0.2)], 150)
        walk.turn(30).go(door, 0.9).turn(140).go(door + 0.3, middle_m)
        walks.append(walk.turn(40, -40) if differs else walk)
    return building, walks


def carried_back(random, differs):
    """A look around in one of two twins, and, without the way there, from another spot in the same
    room."""
    building, room, (first, _), _ = twins(random, differs)
    door, middle_m = first + room.door_m, 0.45 * room.depth_m
    walk = Walk([door, middle_m], 150).turn(30).go(door, 0.9).turn(140)
    again = Walk([door + 0.4, middle_m - 0.3], 30).turn(140).go(door, middle_m).turn(40)
    return building, [walk, again]

# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Storeys of one plan above each other, and walks up and down their stairs."""
from places.building import CEILING, DOOR, METAL, WALL_M, WOOD, Building
from places.rooms import DOOR_M, Room, chair
from places.walk import Walk


class Stairs:
    """Two flights a storey with a half landing between them, in a shaft [x, x + width] x
    [-length, 0]. The first flight is on the left in a view along -y. Landings are at y = 0."""

    LANDING_M = 1.4
    FLIGHT_M = 1.15  # width

    def __init__(self, random, steps):
        self.x, self.steps = 0, steps  # steps of a flight
        self.rise_m, self.run_m = random.uniform(0.175, 0.19), random.uniform(0.27, 0.30)
        self.storey_m = 2 * self.steps * self.rise_m
        self.half_m = self.LANDING_M + self.steps * self.run_m  # from the door to the half landing
        self.length_m = self.half_m + self.LANDING_M
        self.width_m = 2 * self.FLIGHT_M + 0.1

    @property
    def up_x(self):
        """The middle of the first flight."""
        return self.x + self.width_m - 0.55

    @property
    def on_x(self):
        """The middle of the second flight."""
        return self.x + 0.55

    def step(self, building, first, begin_m, top_m):
        """Adds a step of the first or second flight that begins at a distance from the door."""
        x = self.x + (self.width_m - self.FLIGHT_M if first else 0)
        building.box([x, -begin_m - self.run_m, top_m - 0.35],
                     [x + self.FLIGHT_M, -begin_m, top_m], 0.4)

    def build(self, building, storeys, doors):
        """Adds the shaft: `storeys` flights, and a landing more. `doors` are those of the wall
        y = 0, at each landing, for Building.wall()."""
        right = self.x + self.width_m
        building.slab([self.x, -self.length_m], [right, 0], 0)
        for storey in range(storeys):
            floor_m = storey * self.storey_m
            half_m = floor_m + self.storey_m / 2
            for i in range(self.steps):
                risen_m = (i + 1) * self.rise_m
                self.step(building, True, self.LANDING_M + i * self.run_m, floor_m + risen_m)
                self.step(building, False, self.half_m - (i + 1) * self.run_m, half_m + risen_m)
            building.slab([self.x, -self.length_m], [right, -self.half_m], half_m)
            building.slab([self.x, -self.LANDING_M], [right, 0], floor_m + self.storey_m)
            self.furnish(building, half_m)
        top_m = (storeys + 1) * self.storey_m - 0.15
        building.slab([self.x, -self.length_m], [right, 0], top_m + WALL_M, CEILING)
        half_m = WALL_M / 2
        low, high = [self.x - half_m, -self.length_m - half_m], [right + half_m, -half_m]
        building.wall(low, [high[0], low[1]], 0, top_m)
        building.wall(low, [low[0], high[1]], 0, top_m)
        building.wall([high[0], low[1]], high, 0, top_m)
        for storey in range(storeys + 1):
            floor_m = storey * self.storey_m
            building.wall([low[0], high[1]], high, floor_m,
                          min(floor_m + self.storey_m, top_m), doors)

    def furnish(self, building, floor_m):
        """Adds what is on the walls around a half landing: the frame of a window with a radiator
        below it, a column near each corner, and a board on each side, as on the next landing."""
        middle, right, back = self.x + self.width_m / 2, self.x + self.width_m, -self.length_m
        building.box([middle - 0.5, back, floor_m + 0.1],
                     [middle + 0.5, back + 0.12, floor_m + 0.7], METAL)
        for low, high in (([-0.6, 0.9], [-0.5, 2.1]), ([0.5, 0.9], [0.6, 2.1]),
                          ([-0.6, 0.8], [0.6, 0.9]), ([-0.6, 2.1], [0.6, 2.2])):
            building.box([middle + low[0], back, floor_m + low[1]],
                         [middle + high[0], back + 0.1, floor_m + high[1]], WOOD)
        for x in (self.x, right):
            building.column(x, back + 0.3, floor_m, floor_m + 2.3, METAL)
        for y, bottom_m in ((back + 0.5, floor_m), (-1, floor_m + self.storey_m / 2)):
            for x in (self.x, right - 0.08):
                building.box([x, y, bottom_m + 1], [x + 0.08, y + 0.5, bottom_m + 1.7], METAL)

    def climb(self, walk, storey):
        """Walks from the landing of a storey to that of the next. The camera looks along -y first,
        and along y in the end."""
        floor_m = storey * self.storey_m
        half_m, next_m = floor_m + self.storey_m / 2, floor_m + self.storey_m
        yaw_deg = walk.points[-1][3]
        walk.go(self.up_x, 0.1 - self.LANDING_M, floor_m, pitch_deg=0)
        walk.go(self.up_x, -self.half_m - 0.1, half_m).go(self.up_x, -self.half_m - 0.65)
        walk.go(self.on_x, -self.half_m - 0.65, yaw_deg=yaw_deg - 180)
        walk.go(self.on_x, 0.1 - self.half_m)
        return walk.go(self.on_x, 0.1 - self.LANDING_M, next_m).go(self.on_x, -0.6, pitch_deg=-6)

    def descend(self, walk, storey):
        """Walks from the landing of a storey to that of the one below."""
        floor_m = (storey - 1) * self.storey_m
        half_m, from_m = floor_m + self.storey_m / 2, floor_m + self.storey_m
        yaw_deg = walk.points[-1][3]
        walk.go(self.on_x, 0.1 - self.LANDING_M, from_m, pitch_deg=-20)
        walk.go(self.on_x, -self.half_m - 0.1, half_m).go(self.on_x, -self.half_m - 0.65)
        walk.go(self.up_x, -self.half_m - 0.65, yaw_deg=yaw_deg + 180)
        walk.go(self.up_x, 0.1 - self.half_m)
        return walk.go(self.up_x, 0.1 - self.LANDING_M, floor_m).go(self.up_x, -0.6, pitch_deg=-6)


def two_storeys(random, differs):
    """A room, and the one of the same plan above it. With a difference between them, the camera
    comes back down in the end."""
    stairs = Stairs(random, steps=8)
    room = Room(random, height_m=stairs.storey_m - 0.2)
    stairs.x = room.door_m - stairs.width_m / 2
    building = Building()
    for storey in (0, 1):
        room.build(building, [0, 0, storey * stairs.storey_m])
        room.add_columns(building, [0, 0, storey * stairs.storey_m])
    door = (stairs.width_m / 2 - 0.475, stairs.width_m / 2 + 0.475, DOOR_M)
    stairs.build(building, 1, [door])
    for storey in (0, 1):
        for low, high in ((0, stairs.x), (stairs.x + stairs.width_m, room.width_m)):
            building.wall([low, -WALL_M / 2], [high, -WALL_M / 2], storey * stairs.storey_m,
                          (storey + 1) * stairs.storey_m - 0.15)
    if differs:
        building.add(chair(), [room.width_m - 0.75, 0.7, stairs.storey_m], 140)
    middle_m = 0.45 * room.depth_m
    walk = Walk([room.door_m, middle_m], 150 if not differs else 90)
    walk.turn(30, -90).go(room.door_m, -0.6).go(stairs.up_x, -0.7)
    stairs.climb(walk, 0).go(room.door_m, -0.4).go(room.door_m, middle_m)
    if not differs:
        return building, [walk.turn(-210, -330)]
    walk.turn(-300, -450).go(room.door_m, -0.6).go(stairs.on_x, -0.7)
    stairs.descend(walk, 1).go(room.door_m, -0.4)
    return building, [walk.go(room.door_m, middle_m).turn(-290)]


def stairwell(random, differs):
    """A stairwell of three storeys, each with a closed door. The camera climbs two storeys and
    comes back to the first floor, or climbs three."""
    stairs = Stairs(random, steps=7)
    building = Building()
    door = (stairs.width_m / 2 - 0.475, stairs.width_m / 2 + 0.475, DOOR_M)
    stairs.build(building, 3, [door])
    for storey in range(4):
        building.box([0.5, 0, storey * stairs.storey_m],
                     [stairs.width_m - 0.5, 0.05, storey * stairs.storey_m + 2.2], DOOR)
    if differs:
        building.box([0, -0.5, stairs.storey_m + 0.6], [0.12, -0.3, stairs.storey_m + 1.1], METAL)
    walk = Walk([stairs.up_x, -0.6], -90)
    stairs.climb(walk, 0).go(stairs.up_x, -0.6, yaw_deg=-450)
    stairs.climb(walk, 1)
    if not differs:
        walk.go(stairs.up_x, -0.6, yaw_deg=-810)
        return building, [stairs.climb(walk, 2)]
    walk.turn(-810)
    return building, [stairs.descend(walk, 2)]

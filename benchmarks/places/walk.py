# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Paths of a camera that is carried by hand through a building."""
import numpy
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

FRAME_RATE_HZ = 15
MAX_TRANSLATION_M = 0.066  # per frame: a metre per second
MAX_ROTATION_DEG = 2.8     # per frame
ROUNDING_FRAMES = 4        # standard deviation of the smoothing of corners


class Walk:
    """Way points of a camera: position of the feet, yaw and pitch. Yaw 0 looks along x, 90 along y;
    it is not limited to a circle, so that the way points say in which direction the camera turns.
    """

    def __init__(self, place, yaw_deg, pitch_deg=-6, height_m=1.4):
        self.height_m = height_m
        self.points = [[*place, yaw_deg, pitch_deg] if len(place) == 3
                       else [*place, 0, yaw_deg, pitch_deg]]

    def go(self, x, y, z=None, yaw_deg=None, pitch_deg=None):
        """Walks to a place, and turns on the way. What is not given stays as it is."""
        given = [x, y, z, yaw_deg, pitch_deg]
        self.points.append([last if value is None else value
                            for value, last in zip(given, self.points[-1])])
        return self

    def turn(self, *yaws_deg, pitch_deg=None):
        """Turns to one direction after the other, on the spot."""
        for yaw_deg in yaws_deg:
            x, y = self.points[-1][:2]
            self.go(x, y, yaw_deg=yaw_deg, pitch_deg=pitch_deg)
        return self

    def corner(self, x, y, yaw_deg, radius_m=0.5):
        """Walks towards a place and, in an arc before it, turns to where the walk goes on."""
        corner = numpy.array([x, y])
        back = self.points[-1][:2] - corner
        begin = corner + radius_m * back / numpy.linalg.norm(back)
        yaw = numpy.radians(yaw_deg)
        end = corner + radius_m * numpy.array([numpy.cos(yaw), numpy.sin(yaw)])
        return self.go(*begin).go(*end, yaw_deg=yaw_deg)

    def poses(self, random):
        """Positions and rotations of the camera, camera to world, one per frame."""
        along = numpy.array(self.points, float)
        along[:, 2] += self.height_m
        along = at_even_cost(along, 0.05)
        along = gaussian_filter1d(along, ROUNDING_FRAMES / 0.05, axis=0, mode="nearest")
        return swayed(at_even_cost(along, 1), random)


def at_even_cost(along, step):
    """Rows between those of `along` such that it takes `step` frames from one to the next."""
    moved_m = numpy.linalg.norm(numpy.diff(along[:, :3], axis=0), axis=1)
    turned_deg = numpy.linalg.norm(numpy.diff(along[:, 3:], axis=0), axis=1)
    frames = numpy.hypot(moved_m / MAX_TRANSLATION_M, turned_deg / MAX_ROTATION_DEG)
    at = numpy.concatenate([[0], numpy.cumsum(frames)])
    wanted = numpy.linspace(0, at[-1], int(numpy.ceil(at[-1] / step)) + 1)
    return numpy.column_stack([numpy.interp(wanted, at, column) for column in along.T])


def wander(random, count, frames):
    """A random smooth curve of mean square 1 that changes over about so many frames."""
    curve = gaussian_filter1d(random.normal(size=count + 6 * frames), frames)[3 * frames:][:count]
    return curve * numpy.sqrt(2 * numpy.sqrt(numpy.pi) * frames)


def gait(random, count, frames):
    """A sine with a period of about so many frames."""
    period = frames * random.uniform(0.9, 1.1)
    return numpy.sin(2 * numpy.pi * (numpy.arange(count) / period + random.uniform()))


def swayed(along, random):
    """Poses along way points, with the motion of a hand and of steps: two steps a second."""
    count = len(along)
    across_m = 0.010 * gait(random, count, 16) + 0.015 * wander(random, count, 20)
    up_m = 0.010 * gait(random, count, 8) + 0.015 * wander(random, count, 20)
    yaw = numpy.radians(along[:, 3] + 0.7 * gait(random, count, 16) +
                        3 * wander(random, count, 20))
    pitch = numpy.radians(along[:, 4] + 0.5 * gait(random, count, 8) +
                          2 * wander(random, count, 20))
    roll_deg = 0.5 * gait(random, count, 16) + 1.0 * wander(random, count, 25)
    ahead = numpy.column_stack([numpy.cos(pitch) * numpy.cos(yaw),
                                numpy.cos(pitch) * numpy.sin(yaw), numpy.sin(pitch)])
    right = numpy.column_stack([numpy.sin(yaw), -numpy.cos(yaw), numpy.zeros(count)])
    down = numpy.cross(ahead, right)
    rotations = Rotation.from_matrix(numpy.stack([right, down, ahead], axis=-1)) * (
        Rotation.from_euler("z", roll_deg, degrees=True))
    return along[:, :3] + across_m[:, None] * right - numpy.outer(up_m, [0, 0, -1]), rotations

# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads trajectories in the TUM format."""
import numpy
from scipy.spatial.transform import Rotation


def poses(file):
    """The matrices of a trajectory, by their timestamps."""
    matrices = {}
    for row in numpy.atleast_2d(numpy.loadtxt(file)):
        matrix = numpy.eye(4)
        matrix[:3, :3] = Rotation.from_quat(row[4:8]).as_matrix()
        matrix[:3, 3] = row[1:4]
        matrices[round(row[0], 4)] = matrix
    return matrices

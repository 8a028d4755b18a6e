# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Functions of the benchmarks that read meshes and clouds and measure distances from surfaces."""
import numpy
import scipy.spatial


def thinned(points, cell_m):
    """One of the points of each cell of a grid."""
    _, first = numpy.unique(numpy.floor(points / cell_m).astype(int), axis=0, return_index=True)
    return points[first]


PLY_TYPES = {"float": "<f4", "double": "<f8", "uchar": "u1", "ushort": "<u2", "uint": "<u4",
             "int": "<i4", "short": "<i2", "char": "i1"}


def read_ply(file):
    """The vertices (n x 3) and triangles (m x 3, perhaps none) of a binary PLY file of tofmap."""
    with open(file, "rb") as stream:
        header, word, count = {"vertex": (0, [])}, "", 0
        while (line := stream.readline().split()) != [b"end_header"]:
            words = [part.decode() for part in line]
            if words[0] == "element":
                word, count = words[1], int(words[2])
                header[word] = (count, [])
            elif words[0] == "property" and words[1] != "list":
                header[word][1].append((words[2], PLY_TYPES[words[1]]))
        count, fields = header["vertex"]
        rows = numpy.frombuffer(stream.read(count * numpy.dtype(fields).itemsize), fields)
        vertices = numpy.column_stack([rows[axis].astype(float) for axis in "xyz"])
        faces = header.get("face", (0, []))[0]
        record = numpy.dtype([("n", "u1"), ("corners", "<i4", 3)])
        triangles = numpy.frombuffer(stream.read(faces * record.itemsize), record)["corners"]
    return vertices, triangles


class Surface:
    """The triangles of a PLY file, to which distances are asked for."""

    SPACING_M = 0.03  # of samples of the triangles

    def __init__(self, file):
        vertices, triangles = read_ply(file)
        self.corners = vertices[triangles]
        samples, owners = [], []
        for index, (a, b, c) in enumerate(self.corners):
            longest_m = numpy.linalg.norm([b - a, c - a, c - b], axis=1).max()
            steps = max(1, int(numpy.ceil(longest_m / self.SPACING_M)))
            u, v = (part.ravel() / steps for part in numpy.mgrid[:steps + 1, :steps + 1])
            inside = u + v <= 1 + 1e-9
            points = thinned(a + numpy.outer(u[inside], b - a) + numpy.outer(v[inside], c - a),
                             self.SPACING_M / 2)
            samples.append(points)
            owners.append(numpy.full(len(points), index))
        self.tree = scipy.spatial.cKDTree(numpy.concatenate(samples))
        self.owners = numpy.concatenate(owners)

    def distances_m(self, points):
        """Distances of points (n x 3) from the triangles of their four nearest samples."""
        _, nearest = self.tree.query(points, k=4)
        found = [to_triangles_m(points, self.corners[self.owners[column]]) for column in nearest.T]
        return numpy.min(found, axis=0)


def to_triangles_m(points, corners):
    """The distance of each point (n x 3) from its own triangle (n x 3 x 3)."""
    def dot(x, y):
        return numpy.einsum("ij,ij->i", x, y)

    a, b, c = corners.transpose(1, 0, 2)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        distances = []
        for start, end in ((a, b), (b, c), (c, a)):
            edge = end - start
            share = numpy.nan_to_num(numpy.clip(dot(points - start, edge) / dot(edge, edge), 0, 1))
            distances.append(numpy.linalg.norm(points - start - share[:, None] * edge, axis=1))
        normal = numpy.cross(b - a, c - a)
        area = dot(normal, normal)
        u = dot(numpy.cross(c - b, points - b), normal) / area
        v = dot(numpy.cross(a - c, points - c), normal) / area
        off = numpy.abs(dot(points - a, normal)) / numpy.sqrt(area)
        distances.append(numpy.where((u >= 0) & (v >= 0) & (u + v <= 1), off, numpy.inf))
    return numpy.min(distances, axis=0)

# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Functions of the benchmarks that read recordings."""
import numpy
import yaml


def rays(sequence):
    """The unit viewing rays of all pixels of a camera without distortion."""
    with open(f"{sequence}/sequence.yaml", encoding="utf-8") as file:
        camera = yaml.safe_load(file)["camera"]
    u, v = numpy.meshgrid(numpy.arange(camera["width"]), numpy.arange(camera["height"]))
    directions = numpy.stack([(u - camera["cx"]) / camera["fx"], (v - camera["cy"]) / camera["fy"],
                              numpy.ones(u.shape)], axis=-1)
    return directions / numpy.linalg.norm(directions, axis=-1, keepdims=True)


def frames(sequence):
    """The columns of each line of frames.txt: the timestamp, then the files of the frame."""
    with open(f"{sequence}/frames.txt", encoding="utf-8") as file:
        return [line.split() for line in file if line.strip() and not line.startswith("#")]

# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Functions of the benchmarks that make and read recordings and score trajectories."""
import shutil
import subprocess

import numpy
import yaml


def run(*command):
    """Runs a command. Raises an error with its messages if it fails."""
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True,
                          text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: {done.stderr}")


def make(folder, *command):
    """Makes a folder by a command, unless it is there."""
    if folder.exists():
        return
    unfinished = folder.with_suffix(".unfinished")
    shutil.rmtree(unfinished, ignore_errors=True)
    run(*command, "--out", unfinished, "--quiet")
    unfinished.rename(folder)


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


def best_alignment(path, truth):
    """The rotation and translation that fit a path best to the truth (Umeyama 1991). Both have a row
    of three coordinates for each frame."""
    centred, wanted = path - path.mean(axis=0), truth - truth.mean(axis=0)
    u, _, vt = numpy.linalg.svd(wanted.T @ centred)
    rotation = u @ numpy.diag([1, 1, numpy.sign(numpy.linalg.det(u @ vt))]) @ vt
    return rotation, truth.mean(axis=0) - rotation @ path.mean(axis=0)


def position_errors_m(path, truth):
    """Errors of the positions of a path after the alignment that fits it best to the truth."""
    rotation, translation = best_alignment(path, truth)
    return numpy.linalg.norm(path @ rotation.T + translation - truth, axis=1)

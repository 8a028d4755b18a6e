#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Kills `tofmap map` at random moments, resumes it, and compares with a run that was not killed.

    benchmarks/killed_runs.py BUILD_DIR OUT_DIR [--kills N] [--frames N] [--seed N]

A recording of a room is mapped once. Then it is mapped again and again: each process is killed
(SIGKILL) at a random moment, after which the map that it has left is opened, and the next process
resumes it. Whenever one ends before it is killed, its map and path must be the same to the byte as
those of the first run. Ends with 1 if one differs, or cannot be opened or resumed.
"""
import argparse
import pathlib
import random
import shutil
import subprocess
import time

from recording import run

COMPARED = ["map.ply", "trajectory.txt", "keyframes.txt"]


def same(one, other):
    return all((one / name).read_bytes() == (other / name).read_bytes() for name in COMPARED)


def left_maps(out):
    """The maps that killed processes have left beside a result."""
    return list(out.parent.glob(f"{out.name}.partial-*/map.db"))


class Killer:
    def __init__(self, tofmap, sequence, whole, duration_s, seed):
        self.tofmap, self.sequence, self.whole = tofmap, sequence, whole
        self.duration_s = duration_s
        self.random = random.Random(seed)
        self.kills = self.opened = self.finished = 0
        self.failures = []

    def attempt(self, out):
        """Runs until the end or a random moment. Returns whether the run has ended."""
        process = subprocess.Popen(
            [self.tofmap, "map", self.sequence, "--out", out, "--resume", "--quiet"],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            error = process.communicate(timeout=self.random.uniform(0, self.duration_s))[1]
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            self.kills += 1
            if not out.exists():
                self.open_left(out)
                return False
            error = ""  # it was killed when its result was complete
        if not out.exists():
            self.failures.append(f"status {process.returncode}: {error.strip()}")
        elif not same(out, self.whole):
            self.failures.append("a map that was resumed differs")
        self.finished += 1
        return True

    def open_left(self, out):
        for map_file in left_maps(out):
            # It may have been killed before the first commit.
            done = subprocess.run([self.tofmap, "info", map_file], capture_output=True, text=True,
                                  check=False)
            if done.returncode == 0:
                self.opened += 1
            elif "is a map of no recording" not in done.stderr:
                self.failures.append(done.stderr.strip())


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="folder of the build")
    parser.add_argument("out", type=pathlib.Path, help="folder of recordings and maps")
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--frames", type=int, default=120)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    tofmap = arguments.build / "apps" / "tofmap"
    shutil.rmtree(arguments.out, ignore_errors=True)
    arguments.out.mkdir(parents=True)
    sequence, whole = arguments.out / "recording", arguments.out / "whole"
    run(tofmap, "simulate", "room", "--frames", arguments.frames, "--out", sequence, "--quiet",
        "--set", "simulator.width_px=88", "simulator.height_px=72")
    begin = time.monotonic()
    run(tofmap, "map", sequence, "--out", whole, "--quiet")
    killer = Killer(tofmap, sequence, whole, time.monotonic() - begin, arguments.seed)
    while killer.kills < arguments.kills and not killer.failures:
        out = arguments.out / f"run_{killer.finished}"
        if killer.attempt(out):
            shutil.rmtree(out, ignore_errors=True)
    print(f"{killer.kills} kills; {killer.opened} maps opened that were left; "
          f"{killer.finished} runs ended, all with the same map")
    for failure in killer.failures:
        print(failure)
    raise SystemExit(1 if killer.failures else 0)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures memory and the size of the map while a recording is mapped.

    benchmarks/map_memory.py BUILD_DIR RECORDING MAP [--laps FRAMES] [--set OPTION=VALUE ...]

MAP is the folder of the result. With --laps, RECORDING is simulated if it is not there: the laps of
long_run.py, with one ray a pixel, which needs Debian's python3-numpy and python3-matplotlib.

A line for each tenth of the frames has the number of frames that are done, the memory that the
process takes (resident), and the size of the file of the map with its log. The last line has the
largest memory of the whole run, including surface, mesh and report, and the size of the final file.
"""
import argparse
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import time

MEGABYTE = 1e6


def resident_bytes(pid):
    with open(f"/proc/{pid}/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def peak_bytes(pid):
    with open(f"/proc/{pid}/status", encoding="ascii") as file:
        for line in file:
            if line.startswith("VmHWM"):
                return int(line.split()[1]) * 1024
    return 0


def frames_done(progress):
    """The number of the frame that a file of progress messages tells last."""
    done = re.findall(r"mapping frame (\d+) of", progress.read_text(encoding="utf-8"))
    return int(done[-1]) if done else 0


def file_bytes(out):
    """The size of the files of a map that is being made."""
    return sum(file.stat().st_size for file in out.parent.glob(f"{out.name}.partial-*/map.db*"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="folder of the build")
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("map", type=pathlib.Path, help="folder of the result")
    parser.add_argument("--laps", type=int, help="frames of a recording to be simulated")
    parser.add_argument("--set", nargs="+", default=[], help="options of the map")
    arguments = parser.parse_args()
    tofmap = arguments.build / "apps" / "tofmap"
    out = arguments.map
    if arguments.laps and not arguments.recording.exists():
        import long_run  # needs more than this script does
        long_run.simulate(tofmap, arguments.recording, arguments.laps, ["simulator.subpixels=1"])
    out.parent.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(out, ignore_errors=True)
    lines = (arguments.recording / "frames.txt").read_text(encoding="utf-8").splitlines()
    count = sum(not line.startswith("#") for line in lines)
    options = ["--set", *arguments.set] if arguments.set else []
    progress = out.with_suffix(".progress")
    with open(progress, "w", encoding="utf-8") as messages:
        process = subprocess.Popen([tofmap, "map", arguments.recording, "--out", out, *options],
                                   stdout=subprocess.DEVNULL, stderr=messages)
    print("frames  memory MB  file MB", flush=True)
    peak, next_frames = 0, count // 10
    while process.poll() is None:
        time.sleep(1)
        try:
            peak = max(peak, peak_bytes(process.pid))
            resident = resident_bytes(process.pid)
            size = file_bytes(out)
        except (OSError, IndexError):
            continue
        frames = frames_done(progress)
        if frames < next_frames:
            continue
        print(f"{frames:6} {resident / MEGABYTE:10.0f} {size / MEGABYTE:8.1f}", flush=True)
        next_frames += count // 10
    if process.returncode == 0:
        size = (out / "map.db").stat().st_size
        with sqlite3.connect(out / "map.db") as database:
            keyframes = database.execute("SELECT COUNT(*) FROM keyframes").fetchone()[0]
        print(f"   all {peak / MEGABYTE:10.0f} {size / MEGABYTE:8.1f}, {keyframes} keyframes")
    raise SystemExit(process.returncode)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures time per frame and memory of `tofmap map` over a long recording, as a table and a plot.

    benchmarks/long_run.py [BUILD_DIR] [PLOT.png] [FRAMES] [RECORDING]

The camera goes round the simulated room many times, on slightly different paths: displaced by up to
30 cm in each direction and rotated by up to 12 degrees. Needs Debian's python3-numpy and
python3-matplotlib. The recording takes about 150 MB per thousand frames under $TMPDIR. If the
folder RECORDING is given, the recording is kept there, and later runs use it again.
"""
import json
import os
import subprocess
import sys
import tempfile
import time

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

BINS = 10
FRAME_RATE_HZ = 15


def quaternion_about_up(angle):
    return numpy.array([0, 0, numpy.sin(angle / 2), numpy.cos(angle / 2)])


def multiplied(a, b):
    """The product of two quaternions, each x y z w."""
    axis = a[3] * b[:3] + b[3] * a[:3] + numpy.cross(a[:3], b[:3])
    return numpy.append(axis, a[3] * b[3] - a[:3] @ b[:3])


def write_laps(lap_file, out_file, frames):
    """Repeats a closed path with slowly changing offsets, so that laps differ."""
    lap = numpy.loadtxt(lap_file)
    with open(out_file, "w", encoding="ascii") as out:
        for i in range(frames):
            pose = lap[i % len(lap)].copy()
            turns = 2 * numpy.pi * i / len(lap)
            pose[1:4] += 0.3 * numpy.sin(turns * numpy.array([0.13, 0.17, 0.19]))
            pose[4:8] = multiplied(quaternion_about_up(0.2 * numpy.sin(0.23 * turns)), pose[4:8])
            pose[0] = i / FRAME_RATE_HZ
            out.write(" ".join(f"{number:.9g}" for number in pose) + "\n")


def simulate(tofmap, recording, frames, options=()):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([tofmap, "simulate", "room", "--out", f"{folder}/lap", "--quiet",
                        "--set", "simulator.subpixels=1"], check=True)
        write_laps(f"{folder}/lap/groundtruth.txt", f"{folder}/laps.txt", frames)
        subprocess.run([tofmap, "simulate", "room", "--out", recording, "--quiet", "--set",
                        f"simulator.trajectory_file={folder}/laps.txt", *options], check=True)


def resident_mb(pid):
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        for line in status:
            if line.startswith("VmRSS"):
                return int(line.split()[1]) / 1024
    return 0


def map_and_watch(tofmap, sequence, out):
    """Maps a recording. Returns time since the start and resident memory (s, MB), every 0.5 s."""
    run = subprocess.Popen([tofmap, "map", sequence, "--out", out, "--quiet",
                            "--set", "pictures.frames=0"])
    start, samples = time.monotonic(), []
    while run.poll() is None:
        try:
            samples.append((time.monotonic() - start, resident_mb(run.pid)))
        except OSError:
            break
        time.sleep(0.5)
    if run.wait() != 0:
        sys.exit("tofmap map failed")
    return numpy.array(samples)


def main():
    build = sys.argv[1] if len(sys.argv) > 1 else "build"
    plot = sys.argv[2] if len(sys.argv) > 2 else "long_run.png"
    frames = int(sys.argv[3]) if len(sys.argv) > 3 else 5000
    tofmap = f"{build}/apps/tofmap"
    with tempfile.TemporaryDirectory() as folder:
        recording = sys.argv[4] if len(sys.argv) > 4 else f"{folder}/run"
        if not os.path.exists(recording):
            simulate(tofmap, recording, frames)
        memory = map_and_watch(tofmap, recording, f"{folder}/map")
        with open(f"{folder}/map/report.json", encoding="utf-8") as file:
            report = json.load(file)
    stages = list(report["frames"][0]["milliseconds"])
    times = numpy.array([[f["milliseconds"][s] for s in stages] for f in report["frames"]])
    per_frame = times.sum(axis=1)
    # Two frames are prepared at a time, and registered one after the other. The time after the
    # last frame, for the whole map and for files, does not count for any frame.
    in_turn = times[:, [stages.index(s) for s in ("register", "map", "loops")]].sum(axis=1)
    done_s = numpy.cumsum(in_turn + (per_frame - in_turn) / 2) / 1000
    frame_of = numpy.interp(memory[:, 0], done_s, numpy.arange(frames))
    of_frames = memory[:, 0] < done_s[-1]
    keyframes = numpy.cumsum([f.get("tracking", {}).get("is_keyframe", False)
                              for f in report["frames"]])
    print("| frames | ms per frame, all stages | register | loops | keyframes | memory, MB |")
    print("|---|---|---|---|---|---|")
    for part in range(BINS):
        chosen = slice(part * frames // BINS, (part + 1) * frames // BINS)
        seen = memory[of_frames & (frame_of < chosen.stop), 1]
        mean = times[chosen].mean(axis=0)
        print(f"| {chosen.start}-{chosen.stop} | {per_frame[chosen].mean():.1f} | "
              f"{mean[stages.index('register')]:.1f} | {mean[stages.index('loops')]:.2f} | "
              f"{keyframes[chosen.stop - 1]} | {seen[-1]:.0f} |")
    print(f"\nAt the end, while the map is extracted: {memory[:, 1].max():.0f} MB.")
    figure, (upper, lower) = pyplot.subplots(2, 1, figsize=(8, 6), sharex=True)
    window = max(1, frames // 100)
    smooth = numpy.convolve(per_frame, numpy.ones(window) / window, mode="valid")
    upper.plot(numpy.arange(len(smooth)) + window, smooth)
    upper.set(ylabel="ms per frame, two cores", ylim=(0, None))
    lower.plot(frame_of[of_frames], memory[of_frames, 1], label="memory, MB")
    lower.plot(keyframes, label="keyframes")
    lower.set(xlabel="frame", ylim=(0, None))
    lower.legend()
    figure.tight_layout()
    figure.savefig(plot, dpi=100)


if __name__ == "__main__":
    main()

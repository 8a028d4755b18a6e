#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints whether `tofmap map` confuses places that look alike.

    benchmarks/alike_places.py BUILD_DIR OUT_DIR [--kinds KIND ...] [--seeds SEED ...] [--jobs N]

Each kind is a building with places that look alike and a walk through it (benchmarks/places/). The
seed changes dimensions, furniture and path; with an even seed one small object differs between the
places. A map is
- right: one map of at least 95 % of the frames, with an ATE of at most 3 cm,
- WRONG: a loop was used, or maps were joined, between different places (an error of more than 0.2 m
  or 10 degrees between the two frames), or a position has an error of more than 5 cm and the
  verdict is "Looks right.",
- by look: maps were joined that do not belong together, after the camera was not tracked for more
  than two seconds, and the verdict says that this was by look alone,
- unknown: anything else, so several maps that are right, or one that is to be checked.
Each map is aligned with the truth by itself. The verdict is that of report.json, which knows no
truth. Recordings and maps stay in OUT_DIR; recordings that are there are used again. Needs Debian's
python3-numpy, python3-scipy and python3-yaml.
"""
import argparse
import concurrent.futures
import pathlib

from places.kinds import KINDS
from places.recordings import make_recording
from places.score import score
from recording import run

HEADER = ("| kind | seed | frames in each map | ATE, mm | largest error, mm | loops used / found | "
          "wrong loops | wrong joins | verdict | outcome |\n"
          "|---|---|---|---|---|---|---|---|---|---|")


def row_of(kind, seed, found):
    """The row of the table of a score."""
    registered = " + ".join(map(str, found.registered))
    ate_mm = "; ".join(f"{1000 * ate_m:.1f}" for ate_m in found.ate_m)
    return (f"| {kind} | {seed} | {registered} of {found.frames} | {ate_mm} | "
            f"{1000 * found.worst_m:.0f} | {found.used} / {found.loops} | {found.wrong_loops} | "
            f"{found.wrong_joins} | {found.verdict} | {found.outcome} |")


def measure(tofmap, out, kind, seed, settings):
    """Makes, maps and scores one recording. Returns its row of the table."""
    recorded = make_recording(tofmap, out, kind, seed)
    result = recorded.with_name(f"{recorded.name}_map")
    run(tofmap, "map", recorded, "--out", result, "--set", "report.frames=0", "pictures.frames=0",
        *settings)
    return row_of(kind, seed, score(recorded, result))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="folder of the build")
    parser.add_argument("out", type=pathlib.Path, help="folder of recordings and maps")
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS))
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--jobs", type=int, default=1, help="recordings to work on side by side")
    parser.add_argument("--set", nargs="+", default=[], metavar="KEY=VALUE", dest="settings",
                        help="options of tofmap map")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    tofmap = arguments.build / "apps" / "tofmap"
    print(HEADER, flush=True)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        rows = [pool.submit(measure, tofmap, arguments.out, kind, seed, arguments.settings)
                for kind in arguments.kinds for seed in arguments.seeds]
        for row in rows:
            print(row.result(), flush=True)


if __name__ == "__main__":
    main()

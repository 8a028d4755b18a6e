#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Counts how often `tofmap map` says to check a map that is wrong, and one that is right.

    benchmarks/verdict_rates.py BUILD_DIR OUT_DIR RECORDING... [--jobs N]

The recordings have ground truth, such as those that alike_places.py, moving_things.py,
violent_turns.py and `tofmap simulate` make. The verdict is that of report.json, which knows no
truth. A map is wrong if the positions of more than one frame in a hundred are off by more than
5 cm, in the map that the frames are in, after the rigid alignment that fits that map best. It is
questioned if its verdict is not "Looks right." The rates come last, also those for maps that are
wrong by their trajectory error (ATE, RMSE); recordings without a map, since the program failed, are
counted apart. Maps stay in OUT_DIR, under the names of the recordings, and are used again. Needs
Debian's python3-numpy and python3-scipy.
"""
import argparse
import concurrent.futures
import pathlib

from places.score import NOTICED_M, score
from recording import run

HEADER = ("| recording | frames in each map | ATE, mm | error of 99 % / all, mm | verdict | |\n"
          "|---|---|---|---|---|---|")


def map_of(tofmap, out, recorded):
    """Maps a recording, if that was not done before."""
    result = out / f"{recorded.name}_verdict"
    if not (result / "report.json").exists():
        run(tofmap, "map", recorded, "--out", result, "--set", "report.frames=0",
            "pictures.frames=0")
    return result


def measure(tofmap, out, recorded):
    """The score of the map of a recording, or why there is none."""
    try:
        return recorded.name, score(recorded, map_of(tofmap, out, recorded))
    except RuntimeError as error:  # no map
        return recorded.name, " ".join(str(error).split())


def row_of(name, found):
    is_wrong = found.most_m > NOTICED_M
    remark = {(True, False): "MISSED", (False, True): "for nothing"}.get(
        (is_wrong, found.is_questioned), "")
    ate_mm = "; ".join(f"{1000 * ate_m:.1f}" for ate_m in found.ate_m)
    return (f"| {name} | {' + '.join(map(str, found.registered))} of {found.frames} | {ate_mm} | "
            f"{1000 * found.most_m:.0f} / {1000 * found.worst_m:.0f} | {found.verdict} | {remark} |")


def rate(scores, what):
    if not scores:
        return f"no {what} maps"
    questioned = sum(found.is_questioned for found in scores)
    return (f"{questioned} of {len(scores)} {what} maps are questioned "
            f"({100 * questioned / len(scores):.0f} %)")


def rates(scores, error_m):
    """How often maps are questioned that are wrong, and right, by a function of their scores."""
    wrong = [found for found in scores if error_m(found) > NOTICED_M]
    right = [found for found in scores if error_m(found) <= NOTICED_M]
    return f"{rate(wrong, 'wrong')}; {rate(right, 'right')}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="folder of the build")
    parser.add_argument("out", type=pathlib.Path, help="folder of maps")
    parser.add_argument("recordings", type=pathlib.Path, nargs="+")
    parser.add_argument("--jobs", type=int, default=1, help="recordings to work on side by side")
    arguments = parser.parse_args()
    if len({recorded.name for recorded in arguments.recordings}) < len(arguments.recordings):
        parser.error("recordings must have different names")
    arguments.out.mkdir(parents=True, exist_ok=True)
    tofmap = arguments.build / "apps" / "tofmap"
    scores = []
    without_map = 0
    print(HEADER, flush=True)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for name, found in pool.map(lambda one: measure(tofmap, arguments.out, one),
                                    arguments.recordings):
            if isinstance(found, str):
                print(f"| {name} | {found} | | | | |", flush=True)
                without_map += 1
                continue
            print(row_of(name, found), flush=True)
            scores.append(found)
    print(f"\nby the error of 99 %: {rates(scores, lambda found: found.most_m)}\n"
          f"by ATE: {rates(scores, lambda found: max(found.ate_m))}\n{without_map} without a map")


if __name__ == "__main__":
    main()

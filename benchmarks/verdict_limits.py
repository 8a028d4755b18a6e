#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cross-validates the limits of the verdicts on pairs of clouds (docs/registration.md) over scenes.

    benchmarks/verdict_limits.py BUILD_DIR SEQ...

For each recording, limits are chosen that give the fewest errors on the pairs of all other
recordings, and are scored on the pairs of this one: how many wrong pairs would be registered, and
how many right ones rejected. A wrong pair that is registered counts as ten right ones that are
rejected. Beside them stand the figures of the limits that the program has. Clouds and pairs are
those of cloud_pairs.py.
"""
import dataclasses
import sys

import numpy

import cloud_pairs

WRONG_COUNTS_AS = 10
MORE_WITHOUT_OVERLAP = 0.15


@dataclasses.dataclass(frozen=True)
class Limits:
    """Limits of cloud_pair.cpp and CloudRegistrationOptions."""
    support: float = 15
    overlap: float = 0.15
    inlier_ratio: float = 0.6
    free_space_violation: float = 0.023
    direction_share: float = 0.004
    runner_up: float = 0.8


STEPS = numpy.array([0.25, 0.5, 0.7, 0.8, 0.9, 1, 1.1, 1.25, 1.5, 2, 4])
CANDIDATES = {field.name: field.default * STEPS for field in dataclasses.fields(Limits)}


class Pairs:
    """The figures of pairs as arrays, and which of them are right."""

    def __init__(self, recordings):
        """`recordings`: of each, the pairs of report.json and whether they are right."""
        reports = [report for pairs, _ in recordings for report in pairs]
        is_right = [right for _, rights in recordings for right in rights]
        self.is_right = numpy.array(is_right, dtype=bool)
        self.figures = {name: numpy.array([report[name] for report in reports], dtype=float)
                        for name in CANDIDATES}

    def registered(self, limits):
        figure = self.figures
        least_ratio = limits.inlier_ratio + MORE_WITHOUT_OVERLAP * (1 - figure["overlap"])
        return ((figure["support"] >= limits.support) & (figure["overlap"] >= limits.overlap)
                & (figure["inlier_ratio"] >= least_ratio)
                & (figure["free_space_violation"] <= limits.free_space_violation)
                & (figure["direction_share"] >= limits.direction_share)
                & (figure["runner_up"] <= limits.runner_up))

    def errors(self, limits):
        """Numbers of wrong pairs that these limits register, and of right ones that they reject."""
        registered = self.registered(limits)
        return (numpy.count_nonzero(registered & ~self.is_right),
                numpy.count_nonzero(~registered & self.is_right))

    def cost(self, limits):
        wrong, rejected = self.errors(limits)
        return WRONG_COUNTS_AS * wrong + rejected


def best_limits(pairs):
    """Changes one limit at a time as long as that lowers the cost; among equally good values, takes
    the median."""
    limits = Limits()
    while True:
        start = pairs.cost(limits)
        for name, values in CANDIDATES.items():
            costs = [pairs.cost(dataclasses.replace(limits, **{name: v})) for v in values]
            if min(costs) >= pairs.cost(limits):
                continue
            best = [v for v, cost in zip(values, costs) if cost == min(costs)]
            limits = dataclasses.replace(limits, **{name: best[len(best) // 2]})
        if pairs.cost(limits) >= start:
            return limits


def main():
    build, sequences = sys.argv[1], sys.argv[2:]
    if len(sequences) < 2:
        sys.exit(__doc__)
    recordings = {}
    for sequence in sequences:
        _, pairs, is_right, _ = cloud_pairs.registered_pairs(build, sequence)
        recordings[cloud_pairs.name_of(sequence)] = (pairs, is_right)
    print("| recording | pairs | right | limits chosen on the others: wrong registered "
          "| right rejected | limits of the program: wrong registered | right rejected "
          "| chosen limits that differ |\n|---|---|---|---|---|---|---|---|")
    sums = numpy.zeros(6, dtype=int)
    for name, recording in recordings.items():
        held_out = Pairs([recording])
        limits = best_limits(Pairs([r for other, r in recordings.items() if other != name]))
        figures = (held_out.is_right.size, numpy.count_nonzero(held_out.is_right),
                   *held_out.errors(limits), *held_out.errors(Limits()))
        sums += figures
        different = [f"{key} {value:g}" for key, value in dataclasses.asdict(limits).items()
                     if value != getattr(Limits(), key)]
        print(f"| {name} | " + " | ".join(map(str, figures)) + f" | {', '.join(different)} |",
              flush=True)
    print("| all | " + " | ".join(map(str, sums)) + " | |")


if __name__ == "__main__":
    main()

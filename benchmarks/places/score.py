# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scores of maps of places that look alike, against truth."""
import dataclasses
import json
import re

import numpy
from scipy.spatial.transform import Rotation

import recording
from places.walk import FRAME_RATE_HZ

WRONG_M, WRONG_DEG = 0.2, 10  # a loop or join with a larger error is of another place
RIGHT_ATE_M = 0.03
NOTICED_M = 0.05  # a larger error of a position must not pass without a warning


class Path:
    """Poses of some of the frames of a recording, by index."""

    def __init__(self, file, index_at):
        rows = numpy.loadtxt(file, ndmin=2)
        self.indices = [index_at[key_of(row[0])] for row in rows]
        self.row_of = {index: row for row, index in enumerate(self.indices)}
        self.positions_m = rows[:, 1:4]
        self.rotations = Rotation.from_quat(rows[:, 4:8])

    def between(self, one, other):
        """The pose of a frame in the axes of another: translation and rotation."""
        one, other = self.row_of[one], self.row_of[other]
        inverse = self.rotations[one].inv()
        moved_m = self.positions_m[other] - self.positions_m[one]
        return inverse.apply(moved_m), inverse * self.rotations[other]


def key_of(timestamp_s):
    return round(float(timestamp_s), 4)


def is_wrong(path, truth, one, other):
    """Whether a frame is at another place, as seen from one frame, than in truth."""
    translation_m, rotation = path.between(one, other)
    true_translation_m, true_rotation = truth.between(one, other)
    turned_deg = numpy.degrees((true_rotation.inv() * rotation).magnitude())
    return bool(numpy.linalg.norm(translation_m - true_translation_m) > WRONG_M or
                turned_deg > WRONG_DEG)


def wrong_joins(path, truth, times_s):
    """Pairs of frames next to each other in a path between which frames are missing, where the
    later one is at a wrong place as seen from every earlier one. After a drift, a right place is
    wrong as seen from the last frame, but not from those that it was recognised by."""
    joins = [(one, other) for one, other in zip(path.indices, path.indices[1:])
             if times_s[other] - times_s[one] > 1.5 / FRAME_RATE_HZ]
    return [(one, other) for one, other in joins
            if all(is_wrong(path, truth, earlier, other)
                   for earlier in path.indices if earlier <= one)]


@dataclasses.dataclass
class Score:
    """What a map got right. Lists have an entry for each map, the largest map first."""
    frames: int
    registered: list
    ate_m: list
    worst_m: float
    loops: int
    used: int
    wrong_loops: int
    wrong_joins: int
    verdict: str
    reasons: str
    is_warned: bool

    @property
    def outcome(self):
        """`right`: one map of all frames; `unknown`: several maps, or a warning; else `WRONG`."""
        if self.wrong_loops or self.wrong_joins or (
                self.worst_m > NOTICED_M and not self.is_warned):
            return "WRONG"
        is_whole = len(self.registered) == 1 and self.registered[0] >= 0.95 * self.frames
        return "right" if is_whole and self.ate_m[0] <= RIGHT_ATE_M else "unknown"


def score(recorded, result):
    """Scores the result of `tofmap map` against the truth of a recording."""
    report = json.loads((result / "report.json").read_text(encoding="utf-8"))
    times_s = {frame["index"]: frame["timestamp"] for frame in report["frames"]}
    index_at = {key_of(time_s): index for index, time_s in times_s.items()}
    truth = Path(recorded / "groundtruth.txt", index_at)
    paths = [Path(result / "trajectory.txt", index_at)]
    paths += [Path(result / f"trajectory_{number + 2}.txt", index_at)
              for number in range(len(report["summary"]["separate_maps"]))]
    errors_m = [recording.position_errors_m(
        path.positions_m, truth.positions_m[[truth.row_of[index] for index in path.indices]])
        for path in paths]
    loops = report["summary"]["loops"]
    used = [(loop["from"], loop["to"]) for loop in loops if loop["is_used"]]
    page = (result / "report.html").read_text(encoding="utf-8")
    verdict, reasons = re.search(r'class="verdict (\w+)">.*?(?:Reasons: (.*?))?</', page,
                                 re.DOTALL).groups()
    return Score(
        frames=len(times_s), registered=[len(path.indices) for path in paths],
        ate_m=[float(numpy.sqrt((errors ** 2).mean())) for errors in errors_m],
        worst_m=float(max(errors.max() for errors in errors_m)),
        loops=len(loops), used=len(used),
        wrong_loops=sum(is_wrong(path, truth, *pair) for path in paths for pair in used
                        if all(index in path.row_of for index in pair)),
        wrong_joins=sum(len(wrong_joins(path, truth, times_s)) for path in paths),
        verdict=verdict, reasons=reasons or "",
        is_warned=verdict != "good" or bool(report["warnings"]))

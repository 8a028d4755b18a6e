# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scores of maps of places that look alike, against truth."""
import dataclasses
import json

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

    def between(self, one, others):
        """The poses of frames in the axes of one frame: translations and rotations."""
        one, others = self.row_of[one], [self.row_of[other] for other in others]
        inverse = self.rotations[one].inv()
        moved_m = self.positions_m[others] - self.positions_m[one]
        return inverse.apply(moved_m), inverse * self.rotations[others]


def key_of(timestamp_s):
    return round(float(timestamp_s), 4)


def is_wrong(path, truth, one, others):
    """Whether each of the other frames is at another place, as seen from one frame, than in
    truth."""
    translations_m, rotations = path.between(one, others)
    true_translations_m, true_rotations = truth.between(one, others)
    errors_m = numpy.linalg.norm(translations_m - true_translations_m, axis=1)
    errors_deg = numpy.degrees((true_rotations.inv() * rotations).magnitude())
    return (errors_m > WRONG_M) | (errors_deg > WRONG_DEG)


def sections(path, frames):
    """The frames of a path, in sections: a new one begins where frames are missing, and where the
    program had begun a new map."""
    found = [[path.indices[0]]]
    for one, other in zip(path.indices, path.indices[1:]):
        gap_s = frames[other]["timestamp"] - frames[one]["timestamp"]
        is_new = gap_s > 1.5 / FRAME_RATE_HZ or frames[other]["tracking"]["status"] == "first"
        if is_new:
            found.append([])
        found[-1].append(other)
    return found


def wrong_joins(path, truth, frames):
    """Number of sections that lie wrong as seen from every frame of the sections before. Drift
    makes two frames lie wrong to each other, but not those that recognised each other."""
    parts = sections(path, frames)
    return sum(all(is_wrong(path, truth, earlier, part).all() for earlier in sum(parts[:i], []))
               for i, part in enumerate(parts) if i > 0)


@dataclasses.dataclass
class Score:
    """What a map got right. Lists have an entry for each map, the largest map first."""
    frames: int
    registered: list
    ate_m: list
    worst_m: float  # largest error of a position
    most_m: float  # error that at most one frame in a hundred of a map exceeds
    loops: int
    used: int
    wrong_loops: int
    wrong_joins: int
    joins_by_look: int
    verdict: str

    @property
    def is_questioned(self):
        return self.verdict != "good"

    @property
    def outcome(self):
        """`right`: one map of all frames; `unknown`: several maps, or a warning; `by look`: maps
        that do not belong together were joined, but the verdict tells of each such join that it is
        by look alone; else `WRONG`."""
        if 0 < self.wrong_joins <= self.joins_by_look:
            return "by look"
        if self.wrong_loops or self.wrong_joins or (
                self.worst_m > NOTICED_M and not self.is_questioned):
            return "WRONG"
        is_whole = len(self.registered) == 1 and self.registered[0] >= 0.95 * self.frames
        return "right" if is_whole and self.ate_m[0] <= RIGHT_ATE_M else "unknown"


def paths_of(result, report, index_at):
    """The paths of all maps of a result, that of the largest map first."""
    count = len(report["summary"]["separate_maps"])
    names = ["trajectory.txt"] + [f"trajectory_{number + 2}.txt" for number in range(count)]
    return [Path(result / name, index_at) for name in names]


def score(recorded, result):
    """Scores the result of `tofmap map` against the truth of a recording."""
    report = json.loads((result / "report.json").read_text(encoding="utf-8"))
    frames = {frame["index"]: frame for frame in report["frames"]}
    index_at = {key_of(frame["timestamp"]): index for index, frame in frames.items()}
    truth = Path(recorded / "groundtruth.txt", index_at)
    paths = paths_of(result, report, index_at)
    errors_m = [recording.position_errors_m(
        path.positions_m, truth.positions_m[[truth.row_of[index] for index in path.indices]])
        for path in paths]
    loops = report["summary"]["loops"]
    used = [(loop["from"], loop["to"]) for loop in loops if loop["is_used"]]
    return Score(
        frames=len(frames), registered=[len(path.indices) for path in paths],
        ate_m=[float(numpy.sqrt((errors ** 2).mean())) for errors in errors_m],
        worst_m=float(max(errors.max() for errors in errors_m)),
        most_m=float(max(numpy.quantile(errors, 0.99, method="higher") for errors in errors_m)),
        loops=len(loops), used=len(used),
        wrong_loops=sum(bool(is_wrong(path, truth, one, [other])[0]) for path in paths
                        for one, other in used if one in path.row_of and other in path.row_of),
        wrong_joins=sum(wrong_joins(path, truth, frames) for path in paths),
        joins_by_look=report["summary"]["joins"]["by_look_alone"],
        verdict=report["judgement"]["verdict"])

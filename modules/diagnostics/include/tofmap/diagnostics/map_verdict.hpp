// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/verdict.hpp>
#include <tofmap/diagnostics/absence.hpp>

namespace tofmap {

/// A map of fewer of its recording's frames than this is to be checked. Every recording loses some.
inline constexpr double nearly_all_percent = 95;

/// A map with more of its frames registered slowly than this is to be checked: few maps with a
/// right path have as many (benchmarks/troubled_rooms.py, seeds 11 to 15).
inline constexpr double most_slow_percent = 4;

/// A map is to be checked if a position of its path is less certain than this (one standard
/// deviation). Motion that surfaces do not constrain is mostly steadier than its prior: half of the
/// paths are off by less than a quarter of a standard deviation. Of the maps of
/// benchmarks/troubled_rooms.py, seeds 11 to 15 and 21 to 24, none that is off by more than 5 cm
/// has a standard deviation below 9 cm.
inline constexpr double most_position_sigma_m = 0.05;

/// The facts by which a map is judged.
struct MapEvidence {
  int frames = 0;              ///< frames of the recording, including damaged ones
  int registered = 0;          ///< frames that are registered in this map
  MissingFrames missing = {};  ///< frames that are in no map
  int separate = 0;            ///< frames that are registered in separate maps
  int separate_maps = 0;       ///< maps that could not be joined with this one
  int joins = 0;               ///< how often maps were joined after tracking was lost
  int blind_joins = 0;         ///< joins after the camera was not tracked for two seconds
  int joins_taken_back = 0;    ///< joins that later frames contradicted
  int contradicted_loops = 0;  ///< recognised places that the map does not agree with
  /// Standard deviation of the least certain position after the best alignment of the path, by what
  /// surfaces constrain, and the frame at that position.
  double position_sigma_m = 0;
  int least_certain_frame = 0;
  int uncertain = 0;                 ///< frames less certain than most_position_sigma_m
  int registered_slowly = 0;         ///< frames whose registration converged_slowly()
  bool is_empty = false;             ///< the map has no points
  bool is_interrupted = false;       ///< the run was ended early
  bool is_unwrapped = true;          ///< false for method `none`
  std::optional<double> accuracy_m;  ///< mean error of the surface; empty without ground truth
  double voxel_m = 0;                ///< edge length of the map's voxels
  bool is_seen_twice = true;  ///< some frames overlap, so that they can contradict each other
  int warnings = 0;           ///< about the recording or the map
};

/// A verdict and the reasons why it is not better.
struct Judgement {
  Verdict verdict = Verdict::good;
  std::vector<std::string> reasons;  ///< clauses without a full stop; empty for a good verdict
  std::vector<std::string> remarks;  ///< clauses about what the verdict does not depend on
};

/// Judges a map: each part of the evidence gives a verdict, and the worst one counts.
/// docs/reports.md states the rules.
Judgement judge(const MapEvidence& evidence);

/// The verdict on a map that a recording was added to, without what judge() holds against the
/// recording rather than the map: frames that were registered slowly, and a few uncertain ones, no
/// more than may be missing, with a standard deviation of at most 0.2 m. Those slide along the bare
/// walls that they see, and leave the map as it was; if other frames depended on them, these would
/// be as uncertain. Farther off, they might draw a wall past its end.
Verdict verdict_on_extension(MapEvidence evidence);

/// Reasons and remarks as text to append to a sentence: " Reasons: …; …. Also: ….". Empty if there
/// are none.
std::string told_reasons(const Judgement& judgement);

/// The verdict on a map whose ground truth is known: good if the accuracy is at most the size of a
/// voxel, bad if it is more than five times that. NaN, the accuracy of an empty map, is bad.
Verdict verdict_on_accuracy(double accuracy_m, double voxel_m);

/// The verdict on ranges without a map, by the percentage of wrong wrap counts: good up to 2 %, bad
/// above 10 %. NaN (unknown) is to be checked.
Verdict verdict_on_wraps(double wrong_wrap_percent);

/// `part` as a percentage of evidence.frames. 0 if there are no frames.
double percent_of_frames(const MapEvidence& evidence, int part);

}  // namespace tofmap

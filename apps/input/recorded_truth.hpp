// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>

namespace tofmap::app {

/// The truth that a recording holds, as far as it can be read: nothing of it is needed, so what is
/// damaged is left out and remembered. May be used from several threads.
class RecordedTruth {
 public:
  /// Reads the poses; ranges are read when they are asked for. The recording must outlive it.
  explicit RecordedTruth(const SequenceReader& recording);

  /// Those of the lines of groundtruth.txt that are poses.
  const Trajectory& poses() const { return poses_; }

  /// Whether there are true ranges of any frame, damaged or not.
  bool has_ranges() const;

  /// The true ranges of a frame, metres, NaN where unknown; nothing if there are none, or they are
  /// damaged.
  std::optional<ImageF> range_m(int frame) const;

  /// What was found damaged so far, and is not compared with: a sentence for poses and one for
  /// ranges, each with file and line of the first.
  std::vector<std::string> remarks() const;

 private:
  const SequenceReader& recording_;
  Trajectory poses_;
  std::vector<std::string> damaged_poses_;
  mutable std::mutex mutex_;
  mutable std::map<int, std::string> damaged_ranges_;  ///< by frame
};

/// Says remarks of a truth on stderr.
void print_remarks(const RecordedTruth& truth);

}  // namespace tofmap::app

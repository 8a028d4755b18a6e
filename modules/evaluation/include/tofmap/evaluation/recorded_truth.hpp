// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>

namespace tofmap {

/// The ground truth of a recording, as far as it can be read. Damaged parts are left out and
/// remembered, since no command needs the truth. May be used from several threads.
class RecordedTruth {
 public:
  /// Reads the poses now, and ranges when they are asked for. The recording must outlive this.
  explicit RecordedTruth(const SequenceReader& recording);

  /// The lines of groundtruth.txt that hold a pose. Empty if there is no such file.
  const Trajectory& poses() const { return poses_; }

  /// Whether any frame has an image of true ranges, damaged or not.
  bool has_ranges() const;

  /// The true radial ranges of a frame, metres, NaN where unknown. Empty if the frame has no image
  /// of true ranges, or a damaged one.
  std::optional<ImageF> range_m(int frame) const;

  /// What was found to be damaged so far: at most one sentence on poses and one on ranges, each
  /// with file and line of the first damage.
  std::vector<std::string> remarks() const;

 private:
  const SequenceReader& recording_;
  Trajectory poses_;
  std::vector<std::string> damaged_poses_;
  mutable std::mutex mutex_;
  mutable std::map<int, std::string> damaged_ranges_;  ///< by frame
};

}  // namespace tofmap

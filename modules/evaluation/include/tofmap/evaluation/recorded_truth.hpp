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

/// Whether any frame of a recording that is not damaged has a pose, by pose_at().
bool has_pose_of_a_frame(const Trajectory& poses, const std::vector<SequenceFrameFiles>& frames);

/// The ground truth of a recording, as far as it can be read. Damaged parts are left out and named
/// in remarks(), since commands work without truth. Thread-safe.
class RecordedTruth {
 public:
  /// Reads the true poses. True ranges are read when they are requested. The recording must outlive
  /// this.
  explicit RecordedTruth(const SequenceReader& recording);

  /// The poses in the valid lines of groundtruth.txt. Empty if there is no such file.
  const Trajectory& poses() const { return poses_; }

  /// Whether any frame has an image of true ranges, even a damaged one.
  bool has_ranges() const;

  /// The true radial ranges of a frame, metres, NaN where unknown. Empty if the frame has no image
  /// of true ranges, or a damaged one.
  std::optional<ImageF> range_m(int frame) const;

  /// Messages about the damage found so far, each with the first damaged line or file, and about
  /// poses whose times are those of no frame.
  std::vector<std::string> remarks() const;

 private:
  const SequenceReader& recording_;
  Trajectory poses_;
  std::vector<std::string> damaged_poses_;
  mutable std::mutex mutex_;
  mutable std::map<int, std::string> damaged_ranges_;  ///< by frame
};

}  // namespace tofmap

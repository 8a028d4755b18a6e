// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/evaluation/recorded_truth.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

/// A message such as "2 true poses are damaged and left out of all comparisons, the first: …".
std::string remark_on(std::size_t count, std::string_view what, const std::string& first) {
  return counted(count, what) + (count == 1 ? " is" : " are") +
         " damaged and left out of all comparisons" + (count == 1 ? ": " : ", the first: ") + first;
}

}  // namespace

bool has_pose_of_a_frame(const Trajectory& poses, const std::vector<SequenceFrameFiles>& frames) {
  return std::ranges::any_of(frames, [&](const SequenceFrameFiles& frame) {
    return frame.damage.empty() && pose_at(poses, frame.timestamp_s).has_value();
  });
}

RecordedTruth::RecordedTruth(const SequenceReader& recording) : recording_(recording) {
  const std::filesystem::path file = recording.folder() / "groundtruth.txt";
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown) && !unknown) return;
  try {
    UsableTrajectory usable = read_usable_trajectory(file);
    poses_ = std::move(usable.poses);
    damaged_poses_ = std::move(usable.damages);
  } catch (const InputError& error) {
    damaged_poses_.emplace_back(error.what());
  }
}

bool RecordedTruth::has_ranges() const {
  return std::ranges::any_of(recording_.files(), [&](const SequenceFrameFiles& frame) {
    std::error_code unknown;
    const auto file = recording_.folder() / "range_truth" / frame.phases[0].filename();
    return frame.phases[0].has_filename() && std::filesystem::exists(file, unknown);
  });
}

std::optional<ImageF> RecordedTruth::range_m(int frame) const {
  try {
    return recording_.range_truth(frame);
  } catch (const InputError& error) {
    const std::lock_guard lock(mutex_);
    damaged_ranges_.emplace(frame, error.what());
    return std::nullopt;
  }
}

std::vector<std::string> RecordedTruth::remarks() const {
  std::vector<std::string> remarks;
  if (!damaged_poses_.empty()) {
    remarks.push_back(remark_on(damaged_poses_.size(), "true pose", damaged_poses_.front()));
  }
  if (!poses_.empty() && !has_pose_of_a_frame(poses_, recording_.files())) {
    remarks.push_back(
        fmt::format("no true pose is within {} s of any frame, so that none is used; "
                    "does groundtruth.txt belong to this recording?",
                    max_pose_gap_s));
  }
  const std::lock_guard lock(mutex_);
  if (!damaged_ranges_.empty()) {
    remarks.push_back(
        remark_on(damaged_ranges_.size(), "true range image", damaged_ranges_.begin()->second));
  }
  return remarks;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/pipeline/frame_sample.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <tofmap/mapping/moving_regions.hpp>

namespace tofmap {
namespace {

/// How many of the `wanted` frames fit into memory; at least one.
std::size_t fitting_frames(const CameraModel& camera, std::size_t wanted) {
  constexpr std::size_t most_bytes = std::size_t{128} << 20;
  constexpr std::size_t bytes_per_pixel = 52;  // size of a SampledFrame over its pixels
  const auto pixels = static_cast<std::size_t>(camera.width_px * camera.height_px);
  const std::size_t fitting = most_bytes / std::max<std::size_t>(1, bytes_per_pixel * pixels);
  return std::clamp<std::size_t>(fitting, 1, std::max<std::size_t>(1, wanted));
}

/// Mean number of curl violations over the frames that were unwrapped. NaN if there are none, or if
/// the method estimates no phase jumps.
double curl_violations_per_frame(const RoomMap& map, UnwrapMethod method) {
  if (!finds_jumps(method)) return nan;
  double sum = 0;
  int frames = 0;
  for (const FrameRecord& frame : map.frames) {
    if (!frame.is_prepared()) continue;
    sum += frame.curl_violations;
    ++frames;
  }
  return frames > 0 ? sum / frames : nan;
}

}  // namespace

std::vector<int> spread_indices(int total, int wanted) {
  std::vector<int> indices;
  const int count = std::min(total, wanted);
  for (int i = 0; i < count; ++i) {
    const std::int64_t middle = (2 * std::int64_t{i} + 1) * total / (2 * std::int64_t{count});
    indices.push_back(static_cast<int>(middle));
  }
  return indices;
}

FrameSample::FrameSample(const CameraModel& camera, int wanted, std::optional<int> total)
    : has_known_length_(total.has_value()), camera_(camera) {
  const auto most = static_cast<std::size_t>(std::max(1, wanted));
  if (total) {
    most_ = fitting_frames(camera, most);
    wanted_indices_ = spread_indices(*total, std::min(wanted, static_cast<int>(most_)));
  } else {
    most_ = std::max<std::size_t>(2, fitting_frames(camera, 2 * most));
  }
}

void FrameSample::add(const Frame& recorded, const PreparedFrame& prepared) {
  if (!is_its_turn(recorded.index)) return;
  frames_.push_back({recorded, prepared.returns, prepared.unwrapped, prepared.filtered.image});
  SampledFrame& kept = frames_.back();
  kept.returns.amplitudes.clear();
  kept.unwrapped.errors = {};
  unsaved_.insert(recorded.index);
  if (!has_known_length_ && frames_.size() >= most_) drop_every_second();
}

void FrameSample::drop_moving(int index, const SurfaceCloud& still) {
  const auto sampled = std::ranges::find(
      frames_, index, [](const SampledFrame& frame) { return frame.recorded.index; });
  if (sampled == frames_.end()) return;
  read(*sampled);
  unsaved_.insert(index);
  RangeImage& image = sampled->filtered;
  for (Eigen::Index row = 0; row < image.range_m.rows(); ++row) {
    for (Eigen::Index col = 0; col < image.range_m.cols(); ++col) {
      if (moves(still.at(static_cast<int>(col), static_cast<int>(row)))) {
        image.invalidate(row, col, InvalidReason::free_space_violation);
      }
    }
  }
}

bool FrameSample::wants(int index) const {
  return std::ranges::binary_search(wanted_indices_, index);
}

bool FrameSample::is_its_turn(int index) {
  return has_known_length_ ? wants(index) : passed_++ % step_ == 0;
}

void FrameSample::drop_every_second() {
  for (std::size_t i = 1; 2 * i < frames_.size(); ++i) frames_[i] = std::move(frames_[2 * i]);
  frames_.resize((frames_.size() + 1) / 2);
  step_ *= 2;
}

void FrameSample::thin_out(int count) {
  std::vector<SampledFrame> kept;
  for (const int i : spread_indices(static_cast<int>(frames_.size()), count)) {
    kept.push_back(std::move(frames_[static_cast<std::size_t>(i)]));
  }
  frames_ = std::move(kept);
}

Consistency consistency_of(const RoomMap& map, const FrameSample& sample, const SensorModel& sensor,
                           UnwrapMethod method) {
  std::vector<RangedFrame> unwrapped;
  std::vector<RangedFrame> filtered;
  const auto count = static_cast<int>(sample.frames().size());
  for (const int i : spread_indices(count, consistency_frames(sensor.camera))) {
    const SampledFrame& frame = sample.frames()[static_cast<std::size_t>(i)];
    const std::optional<Pose> pose = pose_at(map.trajectory, frame.recorded.timestamp_s);
    unwrapped.push_back({&frame.returns, &frame.unwrapped.image, pose});
    filtered.push_back({&frame.returns, &frame.filtered, pose});
  }
  Consistency consistency = consistency_of(unwrapped, filtered, map.surface, sensor);
  consistency.curl_violations_per_frame = curl_violations_per_frame(map, method);
  return consistency;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/sampled_frames.hpp"

#include <algorithm>
#include <cstdint>

namespace tofmap::app {
namespace {

std::size_t most_frames(const CameraModel& camera, int wanted) {
  constexpr std::size_t most_bytes = std::size_t{128} << 20;
  constexpr std::size_t images = 4;
  const std::size_t frame_bytes =
      images * sizeof(float) * static_cast<std::size_t>(camera.width_px * camera.height_px);
  const std::size_t fitting = most_bytes / std::max<std::size_t>(1, frame_bytes);
  return std::clamp<std::size_t>(2 * static_cast<std::size_t>(std::max(1, wanted)), 2,
                                 std::max<std::size_t>(2, fitting));
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

std::vector<DualFrequencyFrame> sampled_frames(const SequenceReader& recording, int total,
                                               int wanted) {
  std::vector<DualFrequencyFrame> frames;
  for (const int index : spread_indices(std::min(total, *recording.frame_count()), wanted)) {
    SourcedFrame sourced = recording.read(index);
    if (sourced.frame) frames.push_back(*std::move(sourced.frame));
  }
  return frames;
}

SamplingSource::SamplingSource(FrameSource& source, int wanted)
    : source_(source), most_(most_frames(source.sensor().camera, wanted)) {}

std::optional<SourcedFrame> SamplingSource::next() {
  std::optional<SourcedFrame> sourced = source_.next();
  if (!sourced || !sourced->frame) return sourced;
  if (passed_++ % step_ != 0) return sourced;
  kept_.push_back(*sourced->frame);
  if (kept_.size() < most_) return sourced;
  // Every second goes, and from now on half as many come.
  for (std::size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i] = std::move(kept_[2 * i]);
  kept_.resize((kept_.size() + 1) / 2);
  step_ *= 2;
  return sourced;
}

}  // namespace tofmap::app

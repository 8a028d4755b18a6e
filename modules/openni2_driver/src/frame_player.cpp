// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "frame_player.hpp"

#include <utility>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Period of a recording that has a single frame.
constexpr double default_period_s = 0.1;

double median_period_s(const SequenceReader& recording) {
  std::vector<double> periods_s;
  const auto& files = recording.files();
  for (std::size_t i = 1; i < files.size(); ++i) {
    const double period_s = files[i].timestamp_s - files[i - 1].timestamp_s;
    if (period_s > 0) periods_s.push_back(period_s);
  }
  return periods_s.empty() ? default_period_s : median(periods_s);
}

}  // namespace

FramePlayer::FramePlayer(const DeviceRequest& request, std::function<bool()> keep_going)
    : request_(request), keep_going_(std::move(keep_going)) {
  open();
}

void FramePlayer::open() {
  if (request_.is_recording()) {
    auto recording = std::make_unique<SequenceReader>(request_.scene);
    period_s_ = median_period_s(*recording);
    source_ = std::move(recording);
    return;
  }
  const SimulatorOptions& options = request_.simulator;
  source_ =
      std::make_unique<Simulator>(make_scene(request_.scene, options.seed), options, keep_going_);
  period_s_ = 1 / options.frame_rate_hz;
}

std::optional<Frame> FramePlayer::next() {
  while (true) {
    while (const std::optional<SourcedFrame> sourced = source_->next()) {
      if (!sourced->frame) continue;
      Frame frame = *sourced->frame;
      if (!first_s_) first_s_ = frame.timestamp_s;
      frame.timestamp_s += round_start_s_ - *first_s_;
      last_s_ = frame.timestamp_s;
      ++played_;
      return frame;
    }
    if (!keep_going_()) return std::nullopt;
    ++rounds_;
    const bool is_over = request_.player.repeat > 0 && rounds_ >= request_.player.repeat;
    if (is_over || played_ == 0) return std::nullopt;
    open();
    played_ = 0;
    round_start_s_ = last_s_ + period_s_;
  }
}

}  // namespace tofmap

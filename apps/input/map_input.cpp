// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/map_input.hpp"

#include "input/recording.hpp"
#include "input/watched_source.hpp"

namespace tofmap::app {

MapInput::MapInput(const std::filesystem::path& source, const ProgramOptions& options)
    : name_(source.string()), unwrap_(options.pipeline.unwrap) {
  if (is_device_uri(name_)) {
    live_.emplace(name_, options, LiveInput::Wanted{});
  } else {
    recording_.emplace(source, calibration_of(options.camera));
  }
}

FrameSource& MapInput::frames() {
  return recording_ ? static_cast<FrameSource&>(*recording_) : live_->frames();
}

SourceSurvey MapInput::survey() {
  return recording_ ? survey_source(*recording_, unwrap_) : live_->survey();
}

void MapInput::close() {
  if (!live_) return;
  losses_ = live_->losses();
  silence_ = live_->silence();
  acquisition_ = live_->report();
  live_.reset();
}

}  // namespace tofmap::app

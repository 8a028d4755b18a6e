// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/frame.hpp"

#include "tofmap/core/frame_masks.hpp"

#include <algorithm>

namespace tofmap {

Frame blank_frame(std::size_t frequencies) {
  Frame frame;
  frame.phases.resize(frequencies);
  frame.amplitudes.resize(frequencies);
  return frame;
}

Frame frequency_pair(const Frame& frame, std::size_t a, std::size_t b) {
  Frame pair;
  pair.index = frame.index;
  pair.timestamp_s = frame.timestamp_s;
  pair.phases = {frame.phases[a], frame.phases[b]};
  if (frame.has_amplitude()) pair.amplitudes = {frame.amplitudes[a], frame.amplitudes[b]};
  return pair;
}

SensorModel frequency_pair(const SensorModel& sensor, std::size_t a, std::size_t b) {
  SensorModel pair = sensor;
  const Modulation& all = sensor.modulation;
  pair.modulation.frequencies_hz = {all.frequencies_hz[a], all.frequencies_hz[b]};
  if (!all.exposure_offsets_s.empty()) {
    pair.modulation.exposure_offsets_s = {all.exposure_offsets_s[a], all.exposure_offsets_s[b]};
  }
  return pair;
}

bool is_without_return(const Frame& frame) { return missing_returns(frame).all(); }

bool repeats(const Frame& frame, const Frame& last) {
  return std::equal(frame.phases.begin(), frame.phases.end(), last.phases.begin(),
                    last.phases.end(), same_values) &&
         !is_without_return(frame);
}

}  // namespace tofmap

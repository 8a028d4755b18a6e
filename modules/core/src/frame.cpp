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

Frame with_frequencies(const Frame& frame, const std::vector<std::size_t>& frequencies) {
  Frame out;
  out.index = frame.index;
  out.timestamp_s = frame.timestamp_s;
  for (const std::size_t f : frequencies) {
    out.phases.push_back(frame.phases[f]);
    if (frame.has_amplitude()) out.amplitudes.push_back(frame.amplitudes[f]);
  }
  return out;
}

SensorModel with_frequencies(const SensorModel& sensor,
                             const std::vector<std::size_t>& frequencies) {
  SensorModel out = sensor;
  out.modulation = {};
  const Modulation& all = sensor.modulation;
  for (const std::size_t f : frequencies) {
    out.modulation.frequencies_hz.push_back(all.frequencies_hz[f]);
    if (all.exposure_offsets_s.empty()) continue;
    out.modulation.exposure_offsets_s.push_back(all.exposure_offsets_s[f]);
  }
  return out;
}

bool is_without_return(const Frame& frame) { return missing_returns(frame).all(); }

bool repeats(const Frame& frame, const Frame& last) {
  return std::equal(frame.phases.begin(), frame.phases.end(), last.phases.begin(),
                    last.phases.end(), same_values) &&
         !is_without_return(frame);
}

}  // namespace tofmap

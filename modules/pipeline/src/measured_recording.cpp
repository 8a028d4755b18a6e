// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/pipeline/measured_recording.hpp"

#include <algorithm>
#include <utility>

#include <tofmap/core/side_by_side.hpp>

namespace tofmap {

MeasuredRecording::MeasuredRecording(const SequenceReader& source, const UnwrapOptions& options)
    : source_(source), measurer_(source.sensor(), options) {
  std::vector<Frame> first;
  for (int i = 0; i < std::min(FrameMeasurer::frames_ahead, *source.frame_count()); ++i) {
    SourcedFrame sourced = source.read(i);
    if (sourced.frame) first.push_back(*std::move(sourced.frame));
  }
  measurer_.look_ahead(first);
}

std::vector<MeasuredSource> MeasuredRecording::read(int begin, int end) {
  auto sourced = side_by_side(end - begin, [&](int i) { return source_.read(begin + i); });
  std::vector<MeasuredSource> frames;
  for (SourcedFrame& frame : sourced) {
    std::optional<TimedMeasurement> measured;
    if (frame.frame) measured = measure_frame(*frame.frame, measurer_);
    frames.push_back({std::move(frame), std::move(measured)});
  }
  return frames;
}

}  // namespace tofmap

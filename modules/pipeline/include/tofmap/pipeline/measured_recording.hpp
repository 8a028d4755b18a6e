// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {

/// A frame of a recording together with its measured errors.
struct MeasuredSource {
  SourcedFrame sourced;
  std::optional<TimedMeasurement> measured;  ///< empty if the frame is damaged
};

/// Reads a recording in batches: reads the images of a batch in parallel, then measures the frames
/// in order. The first frames are read twice, so that the camera's errors are known from the first
/// frame on (FrameMeasurer::look_ahead).
class MeasuredRecording {
 public:
  MeasuredRecording(const SequenceReader& source, const UnwrapOptions& options);

  /// The frames begin … end − 1. Each call continues where the one before it ended.
  std::vector<MeasuredSource> read(int begin, int end);

 private:
  const SequenceReader& source_;
  FrameMeasurer measurer_;
};

}  // namespace tofmap

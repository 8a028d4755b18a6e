// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {

/// A frame of a recording together with its measured noise and errors.
struct MeasuredSource {
  SourcedFrame sourced;
  std::optional<TimedMeasurement> measured;  ///< empty if the frame is damaged
};

/// Reads a recording in batches. The images of a batch are read in parallel, and then its frames
/// are measured in order. The first frames are read twice, so that the camera's errors are already
/// estimated when the first frame is measured (FrameMeasurer::look_ahead).
class MeasuredRecording {
 public:
  /// Keeps a reference to `source`. Throws UsageError if the options are not allowed.
  MeasuredRecording(const SequenceReader& source, const UnwrapOptions& options);

  /// Reads and measures the frames `begin` … `end` − 1. Calls must follow each other without gaps:
  /// `begin` is 0 in the first call, and the `end` of the previous call in all others.
  std::vector<MeasuredSource> read(int begin, int end);

 private:
  const SequenceReader& source_;
  FrameMeasurer measurer_;
};

}  // namespace tofmap

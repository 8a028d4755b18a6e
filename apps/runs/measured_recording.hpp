// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {

/// A frame of a recording and its errors; nothing is measured of one that is damaged.
struct MeasuredSource {
  SourcedFrame sourced;  ///< its images may have been let go
  std::optional<TimedMeasurement> measured;
};

/// Reads a recording in batches, images side by side, and measures its frames in their order. The
/// first frames are looked at once more than others, to know the camera from the first one on.
class MeasuredRecording {
 public:
  MeasuredRecording(const SequenceReader& source, const UnwrapOptions& options);

  /// The frames begin … end − 1, which follow those of the call before.
  std::vector<MeasuredSource> read(int begin, int end);

 private:
  const SequenceReader& source_;
  FrameMeasurer measurer_;
};

}  // namespace tofmap::app

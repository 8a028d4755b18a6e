// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/calibration/phase_error_fit.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// The reference range of each pixel of a frame, metres, NaN where there is none. Empty if the
/// frame has no reference.
using ReferenceRanges = std::function<std::optional<ImageF>(const Frame&)>;

/// Samples of the pixels of a recording, and the frames that they come from.
struct RecordingSamples {
  /// The frequencies that are compared with the first one: all others, or the first one itself if
  /// there is no other.
  std::vector<std::size_t> others;
  std::vector<std::vector<RangeSample>> samples;  ///< for each of `others`
  std::size_t frames = 0;                         ///< number of frames that samples were taken from
  std::vector<int> frame_indices;                 ///< indices of these frames, in ascending order
  std::vector<Frame> first_frames;                ///< the first twelve of these frames
  int read = 0;              ///< number of frames that were tried, damaged or not
  int damaged = 0;           ///< number of frames that could not be read
  std::string first_damage;  ///< why the first of them could not be read
  /// Number of frames that repeat the one that was read before. They give no samples.
  std::size_t repeated = 0;
};

/// Takes samples (append_range_samples()) of every n-th frame of a recording, at most about two
/// million for each pair of frequencies, spread evenly over frames and pixels. `keep_going` is
/// called with the index of each frame before it is read; if it returns false, the samples so far
/// are returned. It may be empty. Throws UsageError if `every_frame` is less than 1, or if a
/// reference has another size than its frame.
RecordingSamples collect_samples(const SequenceReader& recording, const ReferenceRanges& reference,
                                 int every_frame,
                                 const std::function<bool(int frame)>& keep_going = {});

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::app {

/// What is done with a frame that was unwrapped.
struct UnwrappedFrameOptions {
  double min_confidence = 0;
  bool with_filters = false;
  FilterOptions filters;
};

/// A frame of `tofmap unwrap`, on its way into files.
struct UnwrappedFrame {
  double timestamp_s = 0;
  std::filesystem::path name;     ///< of its images
  std::string damage;             ///< not empty: it could not be read, and there is no image
  RangeImage image;               ///< unwrapped, and filtered if asked for
  nlohmann::ordered_json report;  ///< what became of it
};

/// Reads and unwraps one frame of a recording.
UnwrappedFrame unwrap_frame(const SequenceReader& source, int index, Unwrapper& unwrapper,
                            const PixelRays& rays, const UnwrappedFrameOptions& options);

/// Writes its images into the folders range, wraps, confidence and reason of `out`. Throws
/// InputError if a range does not fit into them.
void write_images(const std::filesystem::path& out, const UnwrappedFrame& frame);

/// Totals and means of the reports of frames.
nlohmann::ordered_json unwrapping_summary(const nlohmann::ordered_json& frames, int damaged,
                                          bool interrupted);

}  // namespace tofmap::app

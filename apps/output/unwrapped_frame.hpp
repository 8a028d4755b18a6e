// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/pipeline/measured_recording.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::app {

/// What is done with a frame that was unwrapped.
struct UnwrappedFrameOptions {
  double min_confidence = 0;
  bool with_filters = false;
  FilterOptions filters;
  bool keep_unfiltered = false;  ///< for pictures
};

/// A frame of `tofmap unwrap`, on its way into files.
struct UnwrappedFrame {
  double timestamp_s = 0;
  std::filesystem::path name;            ///< of its images
  std::string damage;                    ///< not empty: it could not be read, and there is no image
  RangeImage image;                      ///< unwrapped, and filtered if asked for
  std::optional<RangeImage> unfiltered;  ///< as unwrapping returned it, if asked for
  int out_of_range = 0;                  ///< pixels whose range does not fit the image format
  nlohmann::ordered_json report;         ///< what became of it
};

/// Unwraps one frame of a recording; the name of its images is still to be given.
UnwrappedFrame unwrap_frame(const MeasuredSource& source, const Modulation& modulation,
                            Unwrapper& unwrapper, const PixelRays& rays,
                            const UnwrappedFrameOptions& options);

/// Makes pixels invalid, with the reason out_of_range, whose range does not fit into 16 bits of
/// millimetres: below 0.5 mm or beyond 65.535 m. Returns how many.
int drop_out_of_range(RangeImage& image);

/// Notes in its report that a frame was fused with so many others.
void add_fusion_counts(UnwrappedFrame& frame, int views);

/// Drops what does not fit of a frame that was fused since, and tells how much in its report.
void finish_frame(UnwrappedFrame& frame);

/// Writes the images of a finished frame into the folders range, wraps, confidence and reason of
/// `out`. Throws InputError if they cannot be written.
void write_images(const std::filesystem::path& out, const UnwrappedFrame& frame);

/// Totals and means of the reports of frames.
nlohmann::ordered_json unwrapping_summary(const nlohmann::ordered_json& frames, int damaged,
                                          bool interrupted);

}  // namespace tofmap::app

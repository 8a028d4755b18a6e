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

/// What `tofmap unwrap` does with a frame after unwrapping.
struct UnwrappedFrameOptions {
  double min_confidence = 0;     ///< pixels of lower confidence become invalid, 0 … 1
  bool with_filters = false;     ///< applies the filter chain
  FilterOptions filters;         ///< the filter chain
  bool keep_unfiltered = false;  ///< keeps the image before filters, for pictures
};

/// A frame of `tofmap unwrap` before it is written.
struct UnwrappedFrame {
  double timestamp_s = 0;
  std::filesystem::path name;            ///< file name of its images
  std::string damage;                    ///< why the frame could not be read; empty if it could
  RangeImage image;                      ///< unwrapped, and filtered if requested
  std::optional<RangeImage> unfiltered;  ///< as unwrapping returned it, if requested
  int out_of_range = 0;                  ///< pixels whose range does not fit the image format
  nlohmann::ordered_json report;         ///< entry of the frame in report.json
};

/// Unwraps one frame of a recording. The caller sets UnwrappedFrame::name.
UnwrappedFrame unwrap_frame(const MeasuredSource& source, const Modulation& modulation,
                            Unwrapper& unwrapper, const PixelRays& rays,
                            const UnwrappedFrameOptions& options);

/// Invalidates pixels whose range does not fit into 16-bit millimetres, that is below 0.5 mm or
/// above 65.535 m, with the reason out_of_range. Returns their number.
int drop_out_of_range(RangeImage& image);

/// Adds the number of fused frames and of free-space violations to the report of a frame.
void add_fusion_counts(UnwrappedFrame& frame, int views);

/// Drops pixels that are out of range after fusion, and adds their total number to the report. Does
/// nothing for a damaged frame.
void finish_frame(UnwrappedFrame& frame);

/// Writes the images of a finished frame into the folders range, wraps, confidence and reason of
/// `out`. Throws InputError if they cannot be written.
void write_images(const std::filesystem::path& out, const UnwrappedFrame& frame);

/// Totals and means over the reports of all frames.
nlohmann::ordered_json unwrapping_summary(const nlohmann::ordered_json& frames, int damaged,
                                          bool interrupted);

}  // namespace tofmap::app

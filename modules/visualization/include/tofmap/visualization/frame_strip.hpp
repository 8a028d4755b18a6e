// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap {

/// One frame at all stages, from measured phases to filtered ranges. All images have the same size.
struct StagedFrame {
  std::string title;
  ImageF amplitude;      ///< 0 x 0 if the recording has no amplitudes
  ImageF wrapped_m;      ///< wrapped ranges, metres; NaN without a return
  RangeImage unwrapped;  ///< ranges before filters
  RangeImage filtered;   ///< ranges after filters, with the reasons of removed pixels
  ImageF truth_m;        ///< true ranges, metres; 0 x 0 if they are unknown
};

/// The frames of a strip on a page, and their common legends.
struct FrameStrip {
  std::vector<StripFrame> frames;
  std::vector<PageFigure> legends;
};

/// Draws each frame as a row of pictures: amplitude, wrapped range, wrap count, confidence,
/// unwrapped range, removed pixels by reason and, if the truth is known, wrong wraps. Pictures have
/// the size of the camera image, and all frames have the same colour scales. Throws UsageError if
/// the images of a frame differ in size.
FrameStrip frame_strip(const std::vector<StagedFrame>& frames, double wavelength_m);

}  // namespace tofmap

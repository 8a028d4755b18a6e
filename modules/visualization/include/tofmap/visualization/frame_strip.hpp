// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap {

/// One frame on its way from what was measured to what goes into the map.
struct StagedFrame {
  std::string title;
  ImageF amplitude;  ///< 0 x 0: there is none
  ImageF wrapped_m;  ///< ranges as measured, NaN without a return
  RangeImage unwrapped;
  RangeImage filtered;  ///< with the reasons why pixels are gone
  ImageF truth_m;       ///< 0 x 0: not known
};

/// Frames for a page's strip, and the legends of all of them.
struct FrameStrip {
  std::vector<StripFrame> frames;
  std::vector<PageFigure> legends;
};

/// Amplitude, wrapped range, wrap count, confidence, unwrapped range, removed pixels by reason and,
/// where the truth is known, wraps that are wrong. A pixel of the camera is one of the picture, and
/// all frames share their scales. Throws UsageError if the images of a frame differ in size.
FrameStrip frame_strip(const std::vector<StagedFrame>& frames, double wavelength_m);

}  // namespace tofmap

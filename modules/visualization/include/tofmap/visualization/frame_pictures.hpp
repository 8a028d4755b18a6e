// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/visualization/picture.hpp>

namespace tofmap {

/// Wrapped and unwrapped ranges (radial, metres, NaN invalid) side by side, on one colour scale
/// from 0 to the farthest, with a legend in metres.
Picture range_picture(const ImageF& wrapped_m, const ImageF& unwrapped_m);

/// The wrap counts of an image, with a legend of the counts that occur.
Picture wrap_count_picture(const ImageU8& wrap_count);

/// How sure the wrap counts are, on a scale from 0 to 1, with a legend.
Picture confidence_picture(const RangeImage& unwrapped);

/// What one method makes of a frame.
struct MethodRanges {
  std::string title;
  ImageF range_m;  ///< radial, NaN invalid
};

/// One frame by several methods: their ranges in a row on one colour scale, and below them how many
/// wraps each pixel is off, if the true ranges (NaN unknown) are there; these come first then. 0 x
/// 0: they are not.
Picture method_picture(const std::vector<MethodRanges>& methods, const ImageF& truth_m,
                       double wavelength_m);

/// Ranges before filters, and what they removed.
struct FilteredRanges {
  std::string title;
  ImageF range_m;  ///< before, radial, NaN invalid
  ImageU8 reason;  ///< after: InvalidReason as a number
};

/// Filtered images side by side on one colour scale; removed pixels have the colour of the reason,
/// which is in the legend if it occurs.
Picture filter_picture(const std::vector<FilteredRanges>& images);

/// The probabilities of jump nodes, as in figure 7 of the paper: a row a stage, the nodes in x
/// direction left and those in y direction right. Planes are of configurations −1, 0, +1.
struct JumpStage {
  std::string title;
  const std::array<ImageF, 3>* x = nullptr;
  const std::array<ImageF, 3>* y = nullptr;
};
Picture jump_picture(const std::vector<JumpStage>& stages);

}  // namespace tofmap

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

/// A picture of wrapped and unwrapped ranges side by side, with a common colour scale from 0 to the
/// largest range and a legend in metres. Ranges are radial, in metres; NaN is invalid.
Picture range_picture(const ImageF& wrapped_m, const ImageF& unwrapped_m);

/// A picture of the wrap counts of an image, with a legend of the wrap counts that occur.
Picture wrap_count_picture(const ImageU8& wrap_count);

/// A picture of the confidence of the wrap counts, 0 to 1, with a legend.
Picture confidence_picture(const RangeImage& unwrapped);

/// The ranges that one method gives for a frame.
struct MethodRanges {
  std::string title;
  ImageF range_m;  ///< radial, metres; NaN is invalid
};

/// A picture that compares the ranges of several methods for one frame: side by side, with a common
/// colour scale. `truth_m` holds the true ranges (metres, NaN where unknown) and is 0 x 0 if there
/// are none. If there are, the picture begins with them, and below the ranges of each method shows
/// which pixels are wrong by one wrap or more.
Picture method_picture(const std::vector<MethodRanges>& methods, const ImageF& truth_m,
                       double wavelength_m);

/// Ranges before filters, and the pixels that filters removed.
struct FilteredRanges {
  std::string title;
  ImageF range_m;  ///< before filters; radial, metres; NaN is invalid
  ImageU8 reason;  ///< after filters: the number of the InvalidReason
};

/// A picture of filtered images side by side, with a common colour scale. Removed pixels have the
/// colour of their reason. A legend lists the reasons that occur.
Picture filter_picture(const std::vector<FilteredRanges>& images);

/// The probabilities of all jump nodes at one stage. The three images hold the probabilities of the
/// configurations −1, 0 and +1.
struct JumpStage {
  std::string title;
  const std::array<ImageF, 3>* x = nullptr;  ///< nodes between horizontal neighbours, not null
  const std::array<ImageF, 3>* y = nullptr;  ///< nodes between vertical neighbours, not null
};

/// A picture of the probabilities of jump nodes, as in figure 7 of the paper, with one row per
/// stage: nodes in x direction on the left, nodes in y direction on the right.
Picture jump_picture(const std::vector<JumpStage>& stages);

}  // namespace tofmap

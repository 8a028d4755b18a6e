// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "samples.hpp"

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tofmap::bench {

/// A filter and its name.
struct MeasuredFilter {
  std::string name;
  std::function<RangeImage(const Case&, const Sample&)> apply;
};

/// The share of some pixels in all.
struct Share {
  double part = 0;
  double all = 0;

  void add(bool is_part) {
    part += is_part ? 1 : 0;
    all += 1;
  }
  void add(const Share& other) {
    part += other.part;
    all += other.all;
  }
  double percent() const { return 100 * part / all; }
};

/// The effect of a filter on all frames of a case. "Right" pixels are those with the label
/// PixelLabel::right: they see one surface and are off by at most 10 cm.
struct Score {
  static constexpr std::size_t angles = 90;  ///< bins of one degree of incidence angle
  static constexpr std::size_t ranges = 30;  ///< bins of one metre of range
  static constexpr double far_m = 5;

  Share found;                              ///< removed pixels, of the flying ones
  Share found_by_label;                     ///< removed pixels, of those labelled as flying
  Share precise;                            ///< pixels with several surfaces, of the removed ones
  std::array<Share, angles> lost_by_angle;  ///< removed pixels, of the right ones
  std::array<Share, ranges> lost_by_range;  ///< removed pixels, of the right ones

  // Of the kept pixels that see one surface and have the right wrap count:
  double squared_before_m2 = 0;
  double squared_after_m2 = 0;
  double one_surface_kept = 0;
  std::vector<float> before_m;
  std::vector<float> after_m;
  double milliseconds = 0;  ///< per frame

  Share lost() const { return lost_between(0, angles); }
  Share lost_beyond_far() const;
  Share lost_within_a_metre() const { return lost_by_range[0]; }
  Share lost_between(std::size_t from_deg, std::size_t to_deg) const;
  double rmse_m() const;
  double rms_share() const;     ///< RMS error after the filter divided by that before
  double median_share() const;  ///< median error after the filter divided by that before
};

/// Applies a filter to all frames of a case and scores it.
Score score_filter(const MeasuredFilter& filter, const Case& example);

/// The score over the frames of several cases.
Score joined(const std::vector<Score>& scores);

}  // namespace tofmap::bench

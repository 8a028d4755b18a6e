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

/// A filter by its name.
struct Filter {
  std::string name;
  std::function<RangeImage(const Case&, const Sample&)> apply;
};

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

/// What a filter did with all frames of a case. Right pixels see one surface and are off by less
/// than 10 cm.
struct Score {
  static constexpr std::size_t angles = 90;  ///< bins of a degree of incidence
  static constexpr std::size_t ranges = 30;  ///< bins of a metre
  static constexpr double far_m = 5;

  Share found;                              ///< of the flying pixels: removed
  Share found_by_label;                     ///< of the pixels labelled as flying: removed
  Share precise;                            ///< of the removed pixels: flying or mixed
  std::array<Share, angles> lost_by_angle;  ///< of the right pixels: removed
  std::array<Share, ranges> lost_by_range;

  // Of pixels that are kept and see one surface, right or noisy:
  double squared_before_m2 = 0;
  double squared_after_m2 = 0;
  double one_surface_kept = 0;
  std::vector<float> before_m;
  std::vector<float> after_m;
  double milliseconds = 0;  ///< a frame

  Share lost() const { return lost_between(0, angles); }
  Share lost_beyond_far() const;
  Share lost_within_a_metre() const { return lost_by_range[0]; }
  Share lost_between(std::size_t from_deg, std::size_t to_deg) const;
  double rmse_m() const;
  double rms_share() const;     ///< of the error before the filter
  double median_share() const;  ///< the same for the median
};

Score score_filter(const Filter& filter, const Case& example);

/// Scores of several cases together.
Score joined(const std::vector<Score>& scores);

}  // namespace tofmap::bench

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "frame_colors.hpp"

#include "quantile.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {

double round_limit_m(const ImageF& range_m) {
  constexpr double share = 0.998;
  return std::max(1.0F, std::ceil(finite_quantile(range_m, share).value_or(1)));
}

Rgb wrap_error_color(float range_m, float truth_m, double wavelength_m) {
  if (std::isnan(range_m) || std::isnan(truth_m)) return colors::white;
  const double wraps = std::round((range_m - truth_m) / wavelength_m);
  return wraps < 0 ? wrap_errors::too_near : wraps > 0 ? wrap_errors::too_far : wrap_errors::none;
}

Rgb reason_color(InvalidReason reason) {
  switch (reason) {
    case InvalidReason::jump_edge:
      return {214, 39, 40};
    case InvalidReason::low_amplitude:
      return {0, 0, 0};
    case InvalidReason::low_confidence:
      return {255, 255, 255};
    case InvalidReason::isolated_wrap:
      return {204, 121, 167};
    case InvalidReason::ambiguous:
      return {170, 120, 255};
    case InvalidReason::out_of_range:
      return {150, 230, 255};
    case InvalidReason::saturated:
      return {255, 190, 190};
    case InvalidReason::free_space_violation:
      return {120, 60, 20};
    case InvalidReason::outlier:
      return {230, 120, 0};
    case InvalidReason::none:
    case InvalidReason::no_return:
      break;
  }
  return colors::invalid;
}

}  // namespace tofmap

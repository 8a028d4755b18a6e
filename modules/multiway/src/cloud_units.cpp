// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cloud_units.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tofmap {
namespace {

constexpr double max_natural_ratio = 8;       // between spacings of clouds of one scene in one unit
constexpr double least_suspicious_ratio = 2;  // smaller than the ratio of metres and feet
constexpr double spacing_of_a_room = 0.1;

double times_apart(double a, double b) { return std::exp(std::abs(std::log(a / b))); }

}  // namespace

std::vector<bool> of_common_size(std::span<const double> spacings) {
  std::size_t best = 0;
  std::ptrdiff_t most = 0;
  for (std::size_t i = 0; i < spacings.size(); ++i) {
    const auto members = std::ranges::count_if(spacings, [&](double spacing) {
      return times_apart(spacing, spacings[i]) < max_natural_ratio;
    });
    const bool is_nearer = times_apart(spacings[i], spacing_of_a_room) <
                           times_apart(spacings[best], spacing_of_a_room);
    if (members > most || (members == most && is_nearer)) {
      best = i;
      most = members;
    }
  }
  std::vector<bool> is_common;
  for (const double spacing : spacings) {
    is_common.push_back(times_apart(spacing, spacings[best]) < max_natural_ratio);
  }
  return is_common;
}

std::vector<LengthUnit> likely_units(double spacing, double spacing_of_others) {
  static const std::vector<LengthUnit> known{
      {0.001, "millimetres"},
      {0.01, "centimetres"},
      {0.0254, "inches"},
      {0.3048, "feet"},
      {1 / 0.3048, "metres, the others in feet"},
      {1 / 0.0254, "metres, the others in inches"},
      {100, "metres, the others in centimetres"},
      {1000, "metres, the others in millimetres"},
  };
  std::vector<LengthUnit> likely;
  if (times_apart(spacing, spacing_of_others) < least_suspicious_ratio) return likely;
  for (const LengthUnit& unit : known) {
    if (times_apart(spacing * unit.length, spacing_of_others) < max_natural_ratio) {
      likely.push_back(unit);
    }
  }
  std::ranges::stable_sort(likely, std::ranges::less(), [&](const LengthUnit& unit) {
    return times_apart(spacing * unit.length, spacing_of_others);
  });
  return likely;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/modulation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <sstream>
#include <string>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// "29e6, 31e6"
std::string listed(const std::vector<double>& numbers) {
  std::ostringstream text;
  for (std::size_t i = 0; i < numbers.size(); ++i) text << (i == 0 ? "" : ", ") << numbers[i];
  return text.str();
}

void validate_frequencies(const std::vector<double>& hz) {
  if (hz.empty() || hz.size() > most_frequencies) {
    throw InputError("modulation: a camera has one to " + std::to_string(most_frequencies) +
                     " frequencies, got " + std::to_string(hz.size()));
  }
  const auto is_positive = [](double f) { return std::isfinite(f) && f > 0; };
  if (!std::all_of(hz.begin(), hz.end(), is_positive)) {
    throw InputError("modulation: frequencies must be positive, got " + listed(hz) + " Hz");
  }
  constexpr double lowest_hz = 1e4;    // λ = 15 km; a number of megahertz would be far below
  constexpr double highest_hz = 1e11;  // λ = 1.5 mm
  const auto is_plausible = [](double f) { return f >= lowest_hz && f <= highest_hz; };
  if (!std::all_of(hz.begin(), hz.end(), is_plausible)) {
    throw InputError("modulation: frequencies of " + listed(hz) +
                     " Hz are implausible for a time-of-flight camera; give them in hertz, e.g. "
                     "29e6");
  }
  for (std::size_t f = 0; f < hz.size(); ++f) {
    for (std::size_t g = f + 1; g < hz.size(); ++g) {
      if (std::abs(hz[f] - hz[g]) >= 1e-6 * hz[f]) continue;
      throw InputError("modulation: frequencies " + std::to_string(f + 1) + " and " +
                       std::to_string(g + 1) + " are equal (" + listed({hz[f]}) +
                       " Hz); wraps can only be told apart by different frequencies");
    }
  }
}

}  // namespace

std::vector<double> wavelengths_m(const Modulation& modulation) {
  std::vector<double> lengths;
  for (std::size_t f = 0; f < modulation.count(); ++f)
    lengths.push_back(modulation.wavelength_m(f));
  return lengths;
}

std::vector<std::size_t> others_by_wavelength(const std::vector<double>& wavelengths_m) {
  std::vector<std::size_t> others(wavelengths_m.size() - 1);
  std::iota(others.begin(), others.end(), std::size_t{1});
  std::ranges::stable_sort(others, std::ranges::greater(),
                           [&](std::size_t f) { return wavelengths_m[f]; });
  return others;
}

std::size_t counted_frequency(const std::vector<double>& wavelengths_m) {
  const double longest_m = telling_wavelength_ratio * std::ranges::min(wavelengths_m);
  if (wavelengths_m.size() <= 2 && wavelengths_m.front() <= longest_m) return 0;
  std::size_t best = 0;
  double best_m = 0;
  for (std::size_t f = 0; f < wavelengths_m.size(); ++f) {
    if (wavelengths_m[f] > longest_m || wavelengths_m[f] <= best_m) continue;
    best = f;
    best_m = wavelengths_m[f];
  }
  return best;
}

double shortest_wavelength_m(const Modulation& modulation) {
  const std::vector<double> lengths = wavelengths_m(modulation);
  return *std::min_element(lengths.begin(), lengths.end());
}

double longest_wavelength_m(const Modulation& modulation) {
  const std::vector<double> lengths = wavelengths_m(modulation);
  return *std::max_element(lengths.begin(), lengths.end());
}

double mean_wavelength_m(const Modulation& modulation) {
  double sum = 0;
  for (const double wavelength_m : wavelengths_m(modulation)) {
    sum += 1 / (wavelength_m * wavelength_m);
  }
  return 1 / std::sqrt(sum);
}

void validate(const Modulation& modulation) {
  validate_frequencies(modulation.frequencies_hz);
  const std::vector<double>& offsets = modulation.exposure_offsets_s;
  const auto is_finite = [](double offset) { return std::isfinite(offset); };
  const bool has_each = offsets.size() == modulation.count() &&
                        std::all_of(offsets.begin(), offsets.end(), is_finite);
  if (!offsets.empty() && !has_each) {
    throw InputError("modulation: exposure_offsets_s must have a number of seconds for each of " +
                     std::to_string(modulation.count()) + " frequencies, got [" + listed(offsets) +
                     "]");
  }
}

double combined_range_m(const Modulation& modulation, double tolerance_cycles) {
  const double longest_m = longest_wavelength_m(modulation);
  // During one wrap of the longest wavelength, the phase of another one advances by their ratio.
  // By Dirichlet's approximation theorem, k such phases return together to within 1 / n of whole
  // cycles after at most n^k wraps.
  constexpr double most_wraps = 1e6;
  const double per_phase = std::ceil(1 / std::max(tolerance_cycles, 1e-6));
  const double others = static_cast<double>(modulation.count()) - 1;
  const int last = static_cast<int>(std::min(std::pow(per_phase, others), most_wraps));
  const std::vector<double> lengths_m = wavelengths_m(modulation);
  for (int n = 1; n < last; ++n) {
    const auto is_whole = [&](double length_m) {
      const double cycles = n * longest_m / length_m;
      return std::abs(cycles - std::round(cycles)) <= tolerance_cycles;
    };
    if (std::all_of(lengths_m.begin(), lengths_m.end(), is_whole)) return n * longest_m;
  }
  return last * longest_m;
}

int wrap_limit(double wavelength_m, double max_range_m) {
  if (!(std::isfinite(max_range_m) && max_range_m > 0)) {
    throw UsageError("max_range_m must be a positive number of metres");
  }
  return static_cast<int>(std::ceil(max_range_m / wavelength_m - 1e-9));
}

}  // namespace tofmap

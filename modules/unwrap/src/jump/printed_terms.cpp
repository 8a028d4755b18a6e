// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump/printed_terms.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

/// Sums over the phase differences between neighbours.
struct Differences {
  double count = 0;
  double sum = 0;
  double squares = 0;

  void add(float p, float q) {
    const double difference = static_cast<double>(q) - p;
    if (std::isnan(difference)) return;
    count += 1;
    sum += difference;
    squares += difference * difference;
  }

  double variance() const {
    if (count == 0) return 0;
    const double mean = sum / count;
    return squares / count - mean * mean;
  }
};

}  // namespace

double neighbour_variance_cycles2(const ImageF& phase) {
  constexpr double quantisation_cycles = 1 / 65535.0;
  Differences differences;
  for (Eigen::Index v = 0; v < phase.rows(); ++v) {
    for (Eigen::Index u = 0; u < phase.cols(); ++u) {
      if (u + 1 < phase.cols()) differences.add(phase(v, u), phase(v, u + 1));
      if (v + 1 < phase.rows()) differences.add(phase(v, u), phase(v + 1, u));
    }
  }
  return std::max(differences.variance(), quantisation_cycles * quantisation_cycles);
}

ImageU8 threshold_counts(const Frame& frame, const PairLimits& limits, double threshold_m) {
  const auto count_of = [&](float phase_a, float phase_b) {
    if (std::isnan(phase_a) || std::isnan(phase_b)) return invalid_wrap_count;
    const double projected_a_m = std::fmod(phase_a * limits.wavelength_a_m, limits.wavelength_b_m);
    const double difference_m = std::abs(projected_a_m - phase_b * limits.wavelength_b_m);
    return static_cast<std::uint8_t>(difference_m > threshold_m ? 1 : 0);
  };
  ImageU8 counts(frame.phases[0].rows(), frame.phases[0].cols());
  for (Eigen::Index i = 0; i < counts.size(); ++i) {
    counts.data()[i] = count_of(frame.phases[0].data()[i], frame.phases[1].data()[i]);
  }
  return counts;
}

double halfway_threshold_m(const PairLimits& limits) {
  return std::abs(limits.wavelength_a_m - limits.wavelength_b_m) / 2;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/correlation/step_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

constexpr std::size_t fewest_pixels = 50;
constexpr std::size_t pixels_a_bin = 200;  // the median of so many squares is known to 10 %
constexpr std::size_t most_bins = 16;

/// Pixels beyond this number are sampled: medians do not get better than they need to be.
constexpr std::size_t most_pixels = 100000;

/// How often the noise is estimated, each time without the pixels that the last estimate makes
/// inconsistent: with a third of them in the image, the first estimate of the variance is three
/// times too large.
constexpr int passes = 4;

struct Residual {
  float signal = 0;
  float squared = 0;
};

/// The variance that one bin of pixels shows.
struct BinVariance {
  double signal = 0;
  double variance = 0;
};

/// Probability that a χ² variable exceeds x.
double chi_square_tail(int degrees_of_freedom, double x) {
  // Q(n/2, y) by its recurrence Q(a + 1, y) = Q(a, y) + yᵃ e⁻ʸ / Γ(a + 1) from Q(1/2, y) or Q(1,
  // y).
  const double y = x / 2;
  const bool is_odd = degrees_of_freedom % 2 == 1;
  double a = is_odd ? 0.5 : 1;
  double tail = is_odd ? std::erfc(std::sqrt(y)) : std::exp(-y);
  for (; 2 * a < degrees_of_freedom; a += 1) {
    tail += std::exp(a * std::log(y) - y - std::lgamma(a + 1));
  }
  return tail;
}

/// In the order of their signals.
std::vector<Residual> usable_residuals(const ImageF& signal, const ImageF& squared_residual,
                                       const ImageU8& excluded) {
  std::vector<Residual> residuals;
  const Eigen::Index stride = 1 + signal.size() / static_cast<Eigen::Index>(most_pixels);
  for (Eigen::Index i = 0; i < signal.size(); i += stride) {
    const Residual one{std::max(0.0F, signal.data()[i]), squared_residual.data()[i]};
    const bool is_usable =
        excluded.data()[i] == 0 && std::isfinite(signal.data()[i]) && std::isfinite(one.squared);
    if (is_usable) residuals.push_back(one);
  }
  std::ranges::stable_sort(residuals, {}, &Residual::signal);
  return residuals;
}

std::vector<BinVariance> bin_variances(const std::vector<Residual>& residuals,
                                       int degrees_of_freedom, double least_variance) {
  const std::size_t bins = std::clamp<std::size_t>(residuals.size() / pixels_a_bin, 1, most_bins);
  const double median_of_unit_noise = chi_square_quantile(degrees_of_freedom, 0.5);
  std::vector<BinVariance> variances;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const std::size_t first = bin * residuals.size() / bins;
    const std::size_t last = (bin + 1) * residuals.size() / bins;
    std::vector<double> squares;
    for (std::size_t i = first; i < last; ++i) squares.push_back(residuals[i].squared);
    variances.push_back({residuals[(first + last) / 2].signal,
                         std::max(least_variance, median(squares) / median_of_unit_noise)});
  }
  return variances;
}

/// Sum of |log(variance / v)| over all bins; infinite if v is not above 0 in a bin.
double misfit(const StepNoise& noise, const std::vector<BinVariance>& bins) {
  double sum = 0;
  for (const BinVariance& bin : bins) {
    const double expected = noise.variance_at(bin.signal);
    if (!(expected > 0)) return std::numeric_limits<double>::infinity();
    sum += std::abs(std::log(bin.variance / expected));
  }
  return sum;
}

/// Curves through both bins that have a constant and one other term, and those through the first
/// bin alone that have a single term.
std::vector<StepNoise> curves_through(const BinVariance& one, const BinVariance& other) {
  const double s = one.signal;
  std::vector<StepNoise> curves = {{.constant = one.variance}};
  if (s > 0) {
    curves.push_back({.per_signal = one.variance / s});
    curves.push_back({.per_squared_signal = one.variance / (s * s)});
  }
  if (!(other.signal > s)) return curves;
  const double rise = other.variance - one.variance;
  const double linear = rise / (other.signal - s);
  const double square = rise / (other.signal * other.signal - s * s);
  curves.push_back({.constant = one.variance - linear * s, .per_signal = linear});
  curves.push_back({.constant = one.variance - square * s * s, .per_squared_signal = square});
  return curves;
}

bool is_possible(const StepNoise& noise) {
  return noise.constant >= 0 && noise.per_signal >= 0 && noise.per_squared_signal >= 0;
}

/// The curve with the least misfit.
StepNoise best_curve(const std::vector<BinVariance>& bins) {
  StepNoise best;
  double least_misfit = std::numeric_limits<double>::infinity();
  for (const BinVariance& one : bins) {
    for (const BinVariance& other : bins) {
      for (const StepNoise& curve : curves_through(one, other)) {
        const double sum = is_possible(curve) ? misfit(curve, bins) : least_misfit;
        if (sum >= least_misfit) continue;
        least_misfit = sum;
        best = curve;
      }
    }
  }
  return best;
}

}  // namespace

double chi_square_quantile(int degrees_of_freedom, double upper_tail) {
  double low = 0;
  double high = 1;
  while (chi_square_tail(degrees_of_freedom, high) > upper_tail) high *= 2;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = (low + high) / 2;
    (chi_square_tail(degrees_of_freedom, middle) > upper_tail ? low : high) = middle;
  }
  return high;
}

StepNoise estimate_step_noise(const ImageF& signal, const ImageF& squared_residual,
                              const ImageU8& excluded, int degrees_of_freedom,
                              double least_variance) {
  std::vector<Residual> residuals = usable_residuals(signal, squared_residual, excluded);
  const double most = chi_square_quantile(degrees_of_freedom, inconsistent_by_chance);
  StepNoise noise;
  for (int pass = 0; pass < passes; ++pass) {
    if (residuals.size() < fewest_pixels) break;
    noise = best_curve(bin_variances(residuals, degrees_of_freedom, least_variance));
    noise.constant = std::max(noise.constant, least_variance);
    noise.pixels = static_cast<int>(residuals.size());
    std::erase_if(residuals, [&](const Residual& one) {
      return one.squared > most * noise.variance_at(one.signal);
    });
  }
  return noise;
}

ImageU8 inconsistent_pixels(const ImageF& signal, const ImageF& squared_residual,
                            const StepNoise& noise, int degrees_of_freedom) {
  ImageU8 flags = ImageU8::Zero(signal.rows(), signal.cols());
  if (noise.pixels == 0) return flags;
  const double most = chi_square_quantile(degrees_of_freedom, inconsistent_by_chance);
  for (Eigen::Index i = 0; i < signal.size(); ++i) {
    const double variance = noise.variance_at(std::max(0.0F, signal.data()[i]));
    flags.data()[i] = squared_residual.data()[i] > most * variance ? 1 : 0;
  }
  return flags;
}

}  // namespace tofmap

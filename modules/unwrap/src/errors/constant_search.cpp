// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/constant_search.hpp"

#include "errors/exposure_pair.hpp"
#include "errors/median.hpp"
#include "errors/robust_cost.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Scores constants by how well they explain the samples. For each constant, every sample takes its
/// best wrap count, and thereby gets a residual error and a range.
class ConstantScore {
 public:
  ConstantScore(const PairLimits& limits, const ConstantPrior& prior,
                const PredictedSamples& samples)
      : limits_(limits),
        prior_(prior),
        samples_(samples),
        shifted_m_(samples.phase_a.size()),
        error_m_(shifted_m_.size()),
        range_m_(shifted_m_.size()),
        albedo_(samples.amplitude_a.size()) {}

  /// The cost of a constant by equation 24 of docs/unwrapping.md, in nats.
  double cost(double constant_m) {
    for (std::size_t i = 0; i < shifted_m_.size(); ++i) {
      shifted_m_[i] = samples_.predicted_m[i] + static_cast<float>(constant_m);
    }
    find_nearest(limits_, static_cast<int>(shifted_m_.size()), samples_.phase_a.data(),
                 samples_.phase_b.data(), shifted_m_.data(), error_m_.data(), range_m_.data());
    const double of_residuals = robust_cost(error_m_, samples_.variance_m2, prior_.systematic_m);
    return (of_residuals + cost_of_light()) / prior_.correlated_samples +
           constant_m * constant_m / (2 * prior_.constant_m * prior_.constant_m);
  }

 private:
  /// The cost of the samples' reflectances, in nats. The reflectances of the surfaces in a room
  /// vary by about a factor of e. The estimate amplitude times range squared therefore varies less,
  /// the more wrap counts are right.
  double cost_of_light() {
    if (albedo_.empty()) return 0;
    // Samples of one material have the same reflectance, so that two count as one.
    constexpr double samples_of_material = 2;
    constexpr float most = 6;      // limits the influence of outliers
    constexpr double least = 0.2;  // rooms with a more even reflectance do not exist
    for (std::size_t i = 0; i < albedo_.size(); ++i) {
      albedo_[i] = std::log(samples_.amplitude_a[i] * range_m_[i] * range_m_[i]);
    }
    std::vector<float> ordered = albedo_;
    const float middle = median(ordered);
    double sum = 0;
    for (const float albedo : albedo_) sum += std::min(std::abs(albedo - middle), most);
    const auto count = static_cast<double>(albedo_.size());
    return count / samples_of_material * std::log(sum / count + least);
  }

  const PairLimits& limits_;
  const ConstantPrior& prior_;
  const PredictedSamples& samples_;
  std::vector<float> shifted_m_;
  std::vector<float> error_m_;
  std::vector<float> range_m_;
  std::vector<float> albedo_;  ///< logarithm of the reflectance, up to a constant
};

}  // namespace

double largest_constant_m(const PairLimits& limits) {
  constexpr double least_m = 0.12;
  return std::max(least_m, residual_step_m(limits) / 2);
}

double likeliest_constant_m(const PairLimits& limits, const ConstantPrior& prior,
                            const PredictedSamples& samples) {
  constexpr double spacing_m = 0.01;
  if (samples.phase_a.empty()) return 0;
  const double reach_m = largest_constant_m(limits);
  ConstantScore score(limits, prior, samples);
  double best_m = 0;
  double least_cost = score.cost(0);
  for (int k = 1; k * spacing_m < reach_m; ++k) {
    for (const double tried_m : {-k * spacing_m, k * spacing_m}) {
      const double cost = score.cost(tried_m);
      if (cost >= least_cost) continue;
      least_cost = cost;
      best_m = tried_m;
    }
  }
  return best_m;
}

}  // namespace tofmap

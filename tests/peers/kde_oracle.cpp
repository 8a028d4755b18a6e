// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/kde_oracle.hpp"

#include "peers/wrap_triplets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace tofmap::peers {
namespace {

struct Hypothesis {
  double cost;
  double range_m;
  double weight;
  int count_80;
};

double sigma_rad(double amplitude, const PhaseNoise& noise) {
  const double q =
      noise.gamma_0 * amplitude + noise.gamma_1 * amplitude * amplitude + noise.gamma_2;
  const double unit = amplitude_of_q(noise, 1);
  const double largest = std::numbers::pi / 2;
  if (amplitude <= unit) return largest;
  const double beyond = largest * unit / amplitude;
  if (q * q <= 1) return beyond;
  return std::max(0.001, std::min(beyond, std::atan(std::sqrt(1 / (q * q - 1)))));
}

/// The best hypotheses of a pixel of a Kinect v2, whose pseudo-distances are 3, 15 and 2 times the
/// unwrapped phases.
std::vector<Hypothesis> hypotheses_of(const std::array<double, 3>& phase,
                                      const std::array<double, 3>& amplitude,
                                      const std::vector<WrapTriplet>& triplets,
                                      const KdeOptions& options) {
  std::array<double, 3> variance{};
  double amplitude_sum = 0;
  for (std::size_t m = 0; m < 3; ++m) {
    variance[m] = std::pow(sigma_rad(amplitude[m], options.noise[m]), 2);
    amplitude_sum += amplitude[m];
  }
  double likelihood =
      std::exp(-(variance[0] + variance[1] + variance[2]) / (2 * options.phase_scale_rad2));
  if (amplitude_sum >= options.saturated_amplitude_sum) likelihood = 0;

  std::vector<Hypothesis> out;
  for (const WrapTriplet& counts : triplets) {
    const double t_0 = 3 * (phase[0] + counts[0]);
    const double t_1 = 15 * (phase[1] + counts[1]);
    const double t_2 = 2 * (phase[2] + counts[2]);
    const auto& w = options.residual_weights;
    const double cost = w[0] * std::pow(t_0 - t_1, 2) + w[1] * std::pow(t_0 - t_2, 2) +
                        w[2] * std::pow(t_1 - t_2, 2);
    const std::array<double, 3> frequency{80e6, 16e6, 120e6};
    double sum = 0;
    double weights = 0;
    for (std::size_t m = 0; m < 3; ++m) {
      const double wavelength_m = options.camera.speed_of_light_m_s / (2 * frequency[m]);
      const double weight = options.fusion == Fusion::mean_phase
                                ? frequency[m]
                                : frequency[m] * frequency[m] / variance[m];
      sum += weight * wavelength_m * (phase[m] + counts[m]);
      weights += weight;
    }
    const double range_m = sum / weights;
    const double weight = range_m > options.max_range_m
                              ? 0
                              : likelihood * std::exp(-cost / (2 * options.unwrapping_scale));
    out.push_back({cost, range_m, weight, counts[0]});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.cost < b.cost; });
  out.resize(static_cast<std::size_t>(options.hypotheses));
  return out;
}

}  // namespace

KdeResult kde_by_equations(const ThreePhases& phases, const KdeOptions& options) {
  const Eigen::Index rows = phases.rows();
  const Eigen::Index cols = phases.cols();
  const auto triplets =
      wrap_triplets(phases.frequencies_hz, options.camera.speed_of_light_m_s).triplets;
  const auto at = [&](Eigen::Index v, Eigen::Index u) {
    std::vector<Hypothesis> none;
    std::array<double, 3> phase{};
    std::array<double, 3> amplitude{};
    for (std::size_t m = 0; m < 3; ++m) {
      phase[m] = phases.phase_cycles[m](v, u);
      amplitude[m] = phases.amplitude[m](v, u);
      if (std::isnan(phase[m]) || std::isnan(amplitude[m])) return none;
    }
    return hypotheses_of(phase, amplitude, triplets, options);
  };

  KdeResult result{ImageF::Constant(rows, cols, nan), ImageF::Zero(rows, cols),
                   ImageU8::Constant(rows, cols, no_wrap_count)};
  for (Eigen::Index v = 0; v < rows; ++v) {
    for (Eigen::Index u = 0; u < cols; ++u) {
      double best = -1;
      Hypothesis chosen{};
      for (const Hypothesis& candidate : at(v, u)) {
        double density = 0;
        double total = 0;
        const int r = options.support_radius_px;
        for (Eigen::Index y = std::max<Eigen::Index>(0, v - r); y <= std::min(rows - 1, v + r);
             ++y) {
          for (Eigen::Index x = std::max<Eigen::Index>(0, u - r); x <= std::min(cols - 1, u + r);
               ++x) {
            const double squared_px = static_cast<double>((y - v) * (y - v) + (x - u) * (x - u));
            const double spatial =
                std::exp(-squared_px / (2 * options.spatial_sigma_px * options.spatial_sigma_px));
            for (const Hypothesis& other : at(y, x)) {
              const double difference = candidate.range_m - other.range_m;
              total += spatial * other.weight;
              density += spatial * other.weight *
                         std::exp(-difference * difference /
                                  (2 * options.kernel_bandwidth_m * options.kernel_bandwidth_m));
            }
          }
        }
        density /= std::max(total, options.least_total_weight);
        if (density <= best) continue;
        best = density;
        chosen = candidate;
      }
      if (best < 0) continue;
      const bool within =
          chosen.range_m >= options.min_range_m && chosen.range_m <= options.max_range_m;
      result.confidence(v, u) = within ? static_cast<float>(best) : 0.0F;
      result.wrap_count(v, u) = static_cast<std::uint8_t>(chosen.count_80);
      if (result.confidence(v, u) >= options.min_confidence)
        result.range_m(v, u) = static_cast<float>(chosen.range_m);
    }
  }
  return result;
}

}  // namespace tofmap::peers

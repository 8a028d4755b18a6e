// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/range_hypotheses.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap::peers {
namespace {

/// Number of pixels that are ranked at a time.
constexpr int lanes = 16;
using Lanes = std::array<float, lanes>;
using WholeLanes = std::array<std::int32_t, lanes>;

/// A triplet as the cost sees it.
struct Candidate {
  float shift_01;  ///< k₀ n₀ − k₁ n₁
  float shift_02;  ///< k₀ n₀ − k₂ n₂
};

/// Constants of one frequency.
struct Frequency {
  float multiplier;  ///< k
  float wavelength;  ///< of a cycle of range, in units of √2 h
  float fusion;      ///< weight of its range, to be divided by the variance of the phase or not
  float gamma_0;
  float gamma_1;
  float gamma_2;
  float unit;  ///< amplitude_of_q(1)
};

struct Model {
  std::array<Frequency, 3> frequency;
  std::array<float, 3> residual_weight;
  std::vector<Candidate> candidates;
  std::array<std::vector<float>, 3> counts;  ///< wrap counts of each frequency by triplet
  int hypotheses;
  float cost_scale;      ///< 1 / 2s₁²
  float variance_scale;  ///< 1 / 2s₂²
  float saturation;
  float max_range;  ///< in units of √2 h
  bool by_variance;
};

Model model_of(const WrapTriplets& triplets, const ThreePhases& phases, const KdeOptions& options) {
  Model model;
  const double unit_m = std::numbers::sqrt2 * options.kernel_bandwidth_m;
  for (std::size_t m = 0; m < 3; ++m) {
    const double frequency_hz = phases.frequencies_hz[m];
    const double wavelength_m = options.camera.speed_of_light_m_s / (2 * frequency_hz);
    const bool by_variance = options.fusion == Fusion::inverse_variance;
    const double relative = frequency_hz / phases.frequencies_hz[0];
    const PhaseNoise& noise = options.noise[m];
    model.frequency[m] = {
        .multiplier = static_cast<float>(triplets.multiplier[m]),
        .wavelength = static_cast<float>(wavelength_m / unit_m),
        .fusion = static_cast<float>(by_variance ? relative * relative : relative),
        .gamma_0 = static_cast<float>(noise.gamma_0),
        .gamma_1 = static_cast<float>(noise.gamma_1),
        .gamma_2 = static_cast<float>(noise.gamma_2),
        .unit = static_cast<float>(amplitude_of_q(noise, 1))};
    model.residual_weight[m] = static_cast<float>(options.residual_weights[m]);
  }
  for (const WrapTriplet& n : triplets.triplets) {
    const std::array<double, 3>& k = triplets.multiplier;
    model.candidates.push_back({static_cast<float>(k[0] * n[0] - k[1] * n[1]),
                                static_cast<float>(k[0] * n[0] - k[2] * n[2])});
    for (std::size_t m = 0; m < 3; ++m) model.counts[m].push_back(n[m]);
  }
  model.hypotheses = options.hypotheses;
  model.cost_scale = static_cast<float>(0.5 / options.unwrapping_scale);
  model.variance_scale = static_cast<float>(0.5 / options.phase_scale_rad2);
  model.saturation = static_cast<float>(options.saturated_amplitude_sum);
  model.max_range = static_cast<float>(options.max_range_m / unit_m);
  model.by_variance = options.fusion == Fusion::inverse_variance;
  return model;
}

/// The measurements of successive pixels.
struct Pixels {
  std::array<Lanes, 3> phase;
  std::array<Lanes, 3> amplitude;
};

/// The triplets of each pixel with the smallest costs J, best first.
struct Ranking {
  std::array<Lanes, most_hypotheses> cost;
  std::array<WholeLanes, most_hypotheses> triplet;
};

template <int hypotheses>
[[gnu::always_inline]] inline void rank(const Model& model, const Pixels& pixels, Ranking& out) {
  const float k_0 = model.frequency[0].multiplier;
  const float k_1 = model.frequency[1].multiplier;
  const float k_2 = model.frequency[2].multiplier;
  const auto [w_01, w_02, w_12] = model.residual_weight;
  Lanes difference_01;
  Lanes difference_02;
  for (std::size_t l = 0; l < lanes; ++l) {
    difference_01[l] = k_0 * pixels.phase[0][l] - k_1 * pixels.phase[1][l];
    difference_02[l] = k_0 * pixels.phase[0][l] - k_2 * pixels.phase[2][l];
  }
  for (std::size_t r = 0; r < hypotheses; ++r) {
    out.cost[r].fill(1e30F);
    out.triplet[r].fill(0);
  }
  for (std::size_t t = 0; t < model.candidates.size(); ++t) {
    const Candidate candidate = model.candidates[t];
#pragma GCC ivdep
    for (std::size_t l = 0; l < lanes; ++l) {
      const float residual_01 = difference_01[l] + candidate.shift_01;
      const float residual_02 = difference_02[l] + candidate.shift_02;
      const float residual_12 = residual_02 - residual_01;
      float cost = w_01 * residual_01 * residual_01 + w_02 * residual_02 * residual_02 +
                   w_12 * residual_12 * residual_12;
      auto triplet = static_cast<std::int32_t>(t);
#pragma GCC unroll 3
      for (std::size_t r = 0; r < hypotheses; ++r) {
        const float kept_cost = out.cost[r][l];
        const std::int32_t kept = out.triplet[r][l];
        const bool better = cost < kept_cost;
        out.cost[r][l] = better ? cost : kept_cost;
        out.triplet[r][l] = better ? triplet : kept;
        cost = better ? kept_cost : cost;
        triplet = better ? kept : triplet;
      }
    }
  }
}

/// What a pixel's amplitudes say: the likelihood of its phases, and the weight of each frequency in
/// the range, in units of the hypotheses' range per cycle.
struct Evidence {
  Lanes likelihood;
  std::array<Lanes, 3> range_per_cycle;
};

[[gnu::always_inline]] inline void weigh(const Model& model, const Pixels& pixels, Evidence& out) {
  const float variance_share = model.by_variance ? 1.0F : 0.0F;
  const float variance_scale = model.variance_scale;
  const float saturation = model.saturation;
  Lanes variances{};
  Lanes amplitudes{};
  Lanes fusions{};
  for (std::size_t m = 0; m < 3; ++m) {
    const Frequency f = model.frequency[m];
#pragma GCC ivdep
    for (std::size_t l = 0; l < lanes; ++l) {
      const float amplitude = pixels.amplitude[m][l];
      const float sigma = phase_sigma_rad(amplitude, f.gamma_0, f.gamma_1, f.gamma_2, f.unit);
      const float variance = sigma * sigma;
      const float fusion = f.fusion / (variance_share * variance + (1 - variance_share));
      variances[l] += variance;
      amplitudes[l] += amplitude;
      fusions[l] += fusion;
      out.range_per_cycle[m][l] = fusion * f.wavelength;
    }
  }
#pragma GCC ivdep
  for (std::size_t l = 0; l < lanes; ++l) {
    const float valid = amplitudes[l] < saturation ? 1.0F : 0.0F;  // not if NaN
    out.likelihood[l] = valid * exp_of_negative(-variances[l] * variance_scale);
    const float inverse = 1 / fusions[l];
    out.range_per_cycle[0][l] *= inverse;
    out.range_per_cycle[1][l] *= inverse;
    out.range_per_cycle[2][l] *= inverse;
  }
}

/// Where the hypotheses of one rank go.
struct Destination {
  float* range;
  float* weight;
  std::int32_t* triplet;
};

[[gnu::always_inline]] inline void write(const Model& model, const Pixels& pixels,
                                         const Evidence& evidence, const Lanes& cost,
                                         const WholeLanes& triplet, const Destination& out) {
  const float* count_0 = model.counts[0].data();
  const float* count_1 = model.counts[1].data();
  const float* count_2 = model.counts[2].data();
  const float max_range = model.max_range;
  const float cost_scale = model.cost_scale;
#pragma GCC ivdep
  for (std::size_t l = 0; l < lanes; ++l) {
    const std::int32_t t = triplet[l];
    const float range = evidence.range_per_cycle[0][l] * (pixels.phase[0][l] + count_0[t]) +
                        evidence.range_per_cycle[1][l] * (pixels.phase[1][l] + count_1[t]) +
                        evidence.range_per_cycle[2][l] * (pixels.phase[2][l] + count_2[t]);
    // Never so small that products with kernels are denormal, which are slow.
    const float exponent = -cost[l] * cost_scale;
    const float weight =
        evidence.likelihood[l] * exp_of_negative(exponent > -30 ? exponent : -30.0F);
    out.range[l] = range == range ? range : 0.0F;
    const float within = range <= max_range ? 1.0F : 0.0F;  // not if NaN
    out.weight[l] = within * weight;
    out.triplet[l] = t;
  }
}

TOFMAP_VECTOR_CLONES void hypotheses_of_pixels(const Model& model, const Pixels& pixels,
                                               std::span<const Destination> out) {
  Ranking ranking;
  if (model.hypotheses == 2)
    rank<2>(model, pixels, ranking);
  else
    rank<3>(model, pixels, ranking);
  Evidence evidence;
  weigh(model, pixels, evidence);
  for (std::size_t r = 0; r < out.size(); ++r)
    write(model, pixels, evidence, ranking.cost[r], ranking.triplet[r], out[r]);
}

Pixels read(const ThreePhases& phases, Eigen::Index first, Eigen::Index count) {
  Pixels pixels;
  for (std::size_t m = 0; m < 3; ++m) {
    pixels.phase[m].fill(nan);
    pixels.amplitude[m].fill(nan);
    std::copy_n(phases.phase_cycles[m].data() + first, count, pixels.phase[m].begin());
    std::copy_n(phases.amplitude[m].data() + first, count, pixels.amplitude[m].begin());
  }
  return pixels;
}

}  // namespace

RangeHypotheses range_hypotheses(const ThreePhases& phases, const WrapTriplets& triplets,
                                 const KdeOptions& options) {
  const Model model = model_of(triplets, phases, options);
  const Eigen::Index rows = phases.rows();
  const Eigen::Index cols = phases.cols();
  const Eigen::Index whole_cols = (cols + lanes - 1) / lanes * lanes;
  RangeHypotheses out;
  out.count = options.hypotheses;
  out.margin = (options.support_radius_px + lanes - 1) / lanes * lanes;
  for (int i = 0; i < out.count; ++i) {
    const auto r = static_cast<std::size_t>(i);
    out.range[r].setZero(rows, whole_cols + 2 * out.margin);
    out.weight[r].setZero(rows, whole_cols + 2 * out.margin);
    out.triplet[r].resize(rows, whole_cols);
  }
  std::vector<Destination> destinations(static_cast<std::size_t>(out.count));
  for (Eigen::Index v = 0; v < rows; ++v) {
    for (Eigen::Index u = 0; u < cols; u += lanes) {
      for (std::size_t r = 0; r < destinations.size(); ++r)
        destinations[r] = {&out.range[r](v, out.margin + u), &out.weight[r](v, out.margin + u),
                           &out.triplet[r](v, u)};
      hypotheses_of_pixels(
          model, read(phases, v * cols + u, std::min<Eigen::Index>(lanes, cols - u)), destinations);
    }
  }
  return out;
}

}  // namespace tofmap::peers

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/own_counts.hpp"

#include "common/fast_math.hpp"
#include "joint/edge_ratio.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Phases are clear if the unary factor of the second most likely wrap count is at most this large.
constexpr float clear = 1e-3F;

/// A wrap count is certain if the neighbours with clear phases make it this much more likely, by
/// the product of the pairwise factors along the edges to them. One edge has at most 10^6, so this
/// takes three neighbours.
constexpr float certain_support = 1e15F;

/// Pixels processed at a time: few enough for their intermediate results to stay in the first-level
/// cache.
constexpr int block_pixels = 256;
using Block = std::array<float, block_pixels>;

/// The measurements of one frequency in a block; without NaN.
struct Measured {
  Block phase;
  Block variance_m2;
  Block bound;  ///< largest cost of a residual to this frequency, nats
  float wavelength_m;
  float ratio;  ///< wavelength of the first frequency to this one
};

TOFMAP_VECTOR_CLONES void load(int pixels, const float* phase, const float* sigma_cycles,
                               float systematic_m, Measured& out_) {
  Measured& out = out_;
  const float systematic_m2 = systematic_m * systematic_m;
  const float wavelength_m = out.wavelength_m;
  float* to_phase = out.phase.data();
  float* to_variance = out.variance_m2.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const bool is_present = phase[i] == phase[i];
    const float sigma_m = is_present ? sigma_cycles[i] * wavelength_m : 0.0F;
    to_phase[i] = is_present ? phase[i] : 0.0F;
    to_variance[i] = sigma_m * sigma_m + systematic_m2;
  }
}

/// The cost of an outlier: how much less likely it is than a residual of zero (equation 11).
TOFMAP_VECTOR_CLONES void fill_bound(int pixels, const float* first_variance_m2,
                                     float outlier_share, Measured& other_) {
  Measured& other = other_;
  const float surface_odds = (1 - outlier_share) / outlier_share;
  const float squared_m2 = other.wavelength_m * other.wavelength_m;
  const float* variance_m2 = other.variance_m2.data();
  float* bound = other.bound.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float precision = squared_m2 / (first_variance_m2[i] + variance_m2[i] + 1e-12F);
    const float height = std::sqrt(precision * (0.5F / std::numbers::pi_v<float>));
    bound[i] = std::numbers::ln2_v<float> * log2_of(1 + surface_odds * height);
  }
}

/// The two most likely wrap counts of each pixel, and their costs.
struct Candidates {
  Block cost;
  Block count;
  Block next_cost;
  Block next_count;
};

/// The ranges of a block for one wrap count, as the frequencies so far estimate them.
struct Estimate {
  Block change_m;  ///< estimate minus the range of the first frequency
  Block variance_m2;
  Block cost;  ///< of the wrap count, nats
};

TOFMAP_VECTOR_CLONES void start(int pixels, const Measured& first_, float farthest_cycles,
                                Estimate& estimate_) {
  const Measured& first = first_;
  Estimate& estimate = estimate_;
  constexpr float beyond_limits = 1e6F;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const auto at = static_cast<std::size_t>(i);
    estimate.change_m[at] = 0;
    estimate.variance_m2[at] = first.variance_m2[at];
    estimate.cost[at] = first.phase[at] <= farthest_cycles ? 0.0F : beyond_limits;
  }
}

/// Adds the cost of the residual of one more frequency, and fuses the estimate with it unless it is
/// an outlier. `shift` is the change of the residual by the wrap count, in cycles.
TOFMAP_VECTOR_CLONES void add(int pixels, const Measured& first_, const Measured& other_,
                              float shift, Estimate& estimate_) {
  const Measured& first = first_;
  const Measured& other = other_;
  Estimate& estimate = estimate_;
  const float ratio = other.ratio;
  const float wavelength_m = other.wavelength_m;
  const float per_metre = 1 / wavelength_m;
  const float* phase = first.phase.data();
  const float* other_phase = other.phase.data();
  const float* other_m2 = other.variance_m2.data();
  const float* bound = other.bound.data();
  float* change_m = estimate.change_m.data();
  float* variance_m2 = estimate.variance_m2.data();
  float* cost = estimate.cost.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float cycles = phase[i] * ratio + shift - other_phase[i] + change_m[i] * per_metre;
    const float residual_m = wavelength_m * to_half_cycle(cycles);
    const float share = 1 / (variance_m2[i] + other_m2[i] + 1e-12F);
    const float squares = 0.5F * residual_m * residual_m * share;
    const bool is_near = squares < bound[i];
    const float gain = is_near ? variance_m2[i] * share : 0.0F;
    cost[i] += is_near ? squares : bound[i];
    change_m[i] -= gain * residual_m;
    variance_m2[i] *= 1 - gain;
  }
}

TOFMAP_VECTOR_CLONES void keep_least(int pixels, float count, const Estimate& estimate_,
                                     Candidates& out_) {
  const float* cost = estimate_.cost.data();
  float* least = out_.cost.data();
  float* least_count = out_.count.data();
  float* next = out_.next_cost.data();
  float* next_count = out_.next_count.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float now = cost[i];
    const bool is_least = now < least[i];
    const bool is_next = now < next[i];
    const float beaten = is_next ? now : next[i];
    const float beaten_count = is_next ? count : next_count[i];
    next[i] = is_least ? least[i] : beaten;
    next_count[i] = is_least ? least_count[i] : beaten_count;
    least[i] = is_least ? now : least[i];
    least_count[i] = is_least ? count : least_count[i];
  }
}

/// Equation 11 for the given wrap counts, by one more frequency: as in UnaryFactors, without the
/// nearest other wrap, as clear phases are far from it.
TOFMAP_VECTOR_CLONES void multiply_likelihood(int pixels, const Measured& first_,
                                              const Measured& other_, const Block& count_,
                                              float outlier, Estimate& estimate_,
                                              Block& likelihood_) {
  const Measured& first = first_;
  const Measured& other = other_;
  Estimate& estimate = estimate_;
  const float ratio = other.ratio;
  const float wavelength_m = other.wavelength_m;
  const float per_metre = 1 / wavelength_m;
  const float* count = count_.data();
  float* likelihood = likelihood_.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const float shift = to_half_cycle(ratio * count[i]);
    const float cycles =
        first.phase[at] * ratio + shift - other.phase[at] + estimate.change_m[at] * per_metre;
    const float offset = to_half_cycle(cycles);
    const float own_m2 = estimate.variance_m2[at];
    const float share = 1 / (own_m2 + other.variance_m2[at] + 1e-12F);
    const float precision = wavelength_m * wavelength_m * share;
    const float height = std::sqrt(precision * (0.5F / std::numbers::pi_v<float>));
    const float of_surface =
        (1 - outlier) * height * exp_of_negative(-0.5F * precision * offset * offset);
    likelihood[i] *= outlier + of_surface;
    const float trust = of_surface / (outlier + of_surface);
    const float gain = trust * own_m2 * share;
    estimate.change_m[at] -= gain * offset * wavelength_m;
    estimate.variance_m2[at] = own_m2 * (1 - gain);
  }
}

/// What a block of pixels gets.
struct Found {
  std::uint8_t* count;
  float* cycles;        ///< range of the first frequency, in its wavelengths; NaN without a return
  float* odds_against;  ///< by the pixel's own phases; 1 where they are not clear
};

TOFMAP_VECTOR_CLONES void write(int pixels, const float* phase, const std::uint8_t* mixed,
                                const Candidates& candidates_, const Block& likelihood_,
                                const Block& next_likelihood_, float other_counts,
                                const Found& found_) {
  const Found found = found_;
  const float* count = candidates_.count.data();
  const float* likelihood = likelihood_.data();
  const float* next_likelihood = next_likelihood_.data();
  const float floor = other_counts * least_unary_factor;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float share = next_likelihood[i] / likelihood[i];
    const float squared = share * share;
    const float tempered = squared * squared;
    const bool is_clear = tempered <= clear && phase[i] == phase[i] && mixed[i] == 0;
    found.count[i] = static_cast<std::uint8_t>(static_cast<std::int32_t>(count[i]));
    found.cycles[i] = phase[i] + count[i];
    found.odds_against[i] = is_clear ? tempered + floor : 1.0F;
  }
}

/// Finds the wrap counts of the pixels of a frame by themselves, a block at a time.
class BlockFinder {
 public:
  BlockFinder(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
              const std::vector<double>& residual_sigma_m, float outlier_share)
      : frame_(frame),
        limits_(limits),
        sigma_(sigma),
        residual_sigma_m_(residual_sigma_m),
        outlier_share_(outlier_share),
        order_(others_by_wavelength(limits)),
        farthest_cycles_(limits.max_range_m / limits.wavelength_m() + noise_tolerance_cycles),
        others_(order_.size()) {}

  void find(Eigen::Index at, int pixels, const std::uint8_t* mixed, const Found& found) {
    load_frequency(0, at, pixels, first_);
    for (std::size_t i = 0; i < order_.size(); ++i) {
      load_frequency(order_[i], at, pixels, others_[i]);
      fill_bound(pixels, first_.variance_m2.data(), outlier_share_, others_[i]);
    }
    choose_candidates(pixels);
    find_likelihood(pixels, candidates_.count, likelihood_);
    find_likelihood(pixels, candidates_.next_count, next_likelihood_);
    write(pixels, frame_.phases[0].data() + at, mixed, candidates_, likelihood_, next_likelihood_,
          static_cast<float>(std::max(limits_.count - 2, 0)), found);
  }

 private:
  void load_frequency(std::size_t f, Eigen::Index at, int pixels, Measured& out) const {
    out.wavelength_m = static_cast<float>(limits_.wavelengths_m[f]);
    out.ratio = static_cast<float>(limits_.wavelength_m() / limits_.wavelengths_m[f]);
    load(pixels, frame_.phases[f].data() + at, sigma_.cycles[f].data() + at,
         static_cast<float>(residual_sigma_m_[f]), out);
  }

  void choose_candidates(int pixels) {
    constexpr float none = 1e30F;
    candidates_.cost.fill(none);
    candidates_.next_cost.fill(none);
    candidates_.count.fill(0);
    candidates_.next_count.fill(0);
    for (int count = 0; count < limits_.count; ++count) {
      const double farthest = count == 0 ? 1 : farthest_cycles_ - count;
      start(pixels, first_, static_cast<float>(farthest), estimate_);
      for (std::size_t i = 0; i < order_.size(); ++i) {
        const double ratio = limits_.wavelength_m() / limits_.wavelengths_m[order_[i]];
        add(pixels, first_, others_[i], static_cast<float>(residual_shift_cycles(ratio, count)),
            estimate_);
      }
      keep_least(pixels, static_cast<float>(count), estimate_, candidates_);
    }
  }

  void find_likelihood(int pixels, const Block& count, Block& likelihood) {
    start(pixels, first_, 1, estimate_);
    likelihood.fill(1);
    for (const Measured& other : others_) {
      multiply_likelihood(pixels, first_, other, count, outlier_share_, estimate_, likelihood);
    }
  }

  const Frame& frame_;
  const UnwrapLimits& limits_;
  const PhaseSigma& sigma_;
  const std::vector<double>& residual_sigma_m_;
  float outlier_share_;
  std::vector<std::size_t> order_;
  double farthest_cycles_;
  Measured first_;
  std::vector<Measured> others_;
  Candidates candidates_;
  Estimate estimate_;
  Block likelihood_;
  Block next_likelihood_;
};

/// Successive pixels whose phases have been unwrapped by themselves.
struct Unwrapped {
  const float* cycles;
  const float* sigma_cycles;
  const float* amplitude;
  const float* odds_against;
};

/// The roots of the pairwise factors along the edges between pixels and one neighbour of each; 1 if
/// the phases of either are not clear.
TOFMAP_VECTOR_CLONES void fill_support(int pixels, const Unwrapped& from_, const Unwrapped& to_,
                                       const EdgeScale& scale_, float* support) {
  const Unwrapped from = from_;
  const Unwrapped to = to_;
  const EdgeScale scale = scale_;
  const float variance_scale = scale.wavelength_m * scale.wavelength_m;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    // NaN where there is no return, which is not clear.
    const float difference = to.cycles[i] - from.cycles[i];
    const float variance =
        from.sigma_cycles[i] * from.sigma_cycles[i] + to.sigma_cycles[i] * to.sigma_cycles[i];
    const float odds = from.odds_against[i];
    const float other_odds = to.odds_against[i];
    const float greater = odds > other_odds ? odds : other_odds;
    const bool are_clear = greater <= 1.1F * clear;
    const float variance_m2 = are_clear ? variance * variance_scale : 1.0F;
    const EdgeRatio ratio(scale, variance_m2, from.amplitude[i], to.amplitude[i]);
    const float r = ratio(are_clear ? difference : 0.0F);
    const float squared = r * r;
    const float bounded = squared < largest_root_ratio ? squared : largest_root_ratio;
    const float raised = bounded > 1 ? bounded : 1.0F;
    support[i] = are_clear ? raised : 1.0F;
  }
}

/// Finds certain pixels of a row, and replaces the odds against their wrap counts by those of their
/// beliefs. `before` and `after` are the supports along the edges to opposite neighbours.
TOFMAP_VECTOR_CLONES void finish_row(int pixels, const float* left, const float* right,
                                     const float* above, const float* below,
                                     const float* odds_against, std::uint8_t* certain,
                                     float* belief_against) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float support = left[i] * right[i] * (above[i] * below[i]);
    certain[i] = support >= certain_support ? 1 : 0;
    belief_against[i] = odds_against[i] / support;
  }
}

}  // namespace

OwnCounts find_own_counts(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                          const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior,
                          const ImageU8& mixed) {
  const Eigen::Index rows = frame.rows();
  const Eigen::Index cols = frame.cols();
  OwnCounts out{ImageU8(rows, cols), ImageU8(rows, cols), ImageF(rows, cols)};
  ImageF cycles(rows, cols);
  ImageF odds_against(rows, cols);
  BlockFinder finder(frame, limits, sigma, residual_sigma_m,
                     static_cast<float>(prior.outlier_share));
  for (Eigen::Index at = 0; at < cycles.size(); at += block_pixels) {
    const auto pixels = static_cast<int>(std::min<Eigen::Index>(block_pixels, cycles.size() - at));
    finder.find(at, pixels, mixed.data() + at,
                {out.count.data() + at, cycles.data() + at, odds_against.data() + at});
  }

  const EdgeScale scale(limits, prior);
  const ImageF unknown_amplitude =
      frame.has_amplitude() ? ImageF() : ImageF::Ones(rows, cols).eval();
  const ImageF& amplitude = frame.has_amplitude() ? frame.amplitudes[0] : unknown_amplitude;
  const auto unwrapped = [&](Eigen::Index at) {
    return Unwrapped{cycles.data() + at, sigma.cycles[0].data() + at, amplitude.data() + at,
                     odds_against.data() + at};
  };
  const auto width = static_cast<int>(cols);
  // Supports along edges across the border of the image stay 1.
  std::vector<float> across(static_cast<std::size_t>(cols) + 1, 1.0F);
  std::vector<float> above(static_cast<std::size_t>(cols), 1.0F);
  std::vector<float> below(static_cast<std::size_t>(cols), 1.0F);
  for (Eigen::Index v = 0; v < rows; ++v) {
    const Eigen::Index at = v * cols;
    fill_support(width - 1, unwrapped(at), unwrapped(at + 1), scale, across.data() + 1);
    if (v + 1 < rows) {
      fill_support(width, unwrapped(at), unwrapped(at + cols), scale, below.data());
    } else {
      std::ranges::fill(below, 1.0F);
    }
    finish_row(width, across.data(), across.data() + 1, above.data(), below.data(),
               odds_against.data() + at, out.certain.data() + at, out.odds_against.data() + at);
    above.swap(below);
  }
  return out;
}

}  // namespace tofmap

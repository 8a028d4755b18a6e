// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ambient_noise.hpp"

#include "phase_differences.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

constexpr Eigen::Index block_px = 16;

/// Standard deviations below which half of all normal numbers lie, and nearly all.
constexpr float half_sigmas = 0.6745F;
constexpr float most_sigmas = 2.5F;

/// Differences of one block: how many there are, and how many are small.
struct Shares {
  float all = 0;
  float below_half = 0;
  float below_most = 0;
};

/// Rows of 1 and 0: is there a difference, and is it below each limit.
TOFMAP_VECTOR_CLONES void compare(int count, const float* cycles, const float* relative_sigma,
                                  float scale, float* present, float* below_half,
                                  float* below_most) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float size = cycles[i] < 0 ? -cycles[i] : cycles[i];
    const float sigma = scale * relative_sigma[i];
    present[i] = sigma < 1e9F ? 1.0F : 0.0F;
    below_half[i] = size < half_sigmas * sigma && sigma < 1e9F ? 1.0F : 0.0F;
    below_most[i] = size < most_sigmas * sigma && sigma < 1e9F ? 1.0F : 0.0F;
  }
}

/// One share for each block, row by row.
class BlockShares {
 public:
  BlockShares(Eigen::Index rows, Eigen::Index cols)
      : rows_((rows + block_px - 1) / block_px),
        cols_((cols + block_px - 1) / block_px),
        shares_(static_cast<std::size_t>(rows_ * cols_)) {}

  Eigen::Index rows() const { return rows_; }
  Eigen::Index cols() const { return cols_; }
  const Shares& operator()(Eigen::Index row, Eigen::Index col) const {
    return shares_[static_cast<std::size_t>(row * cols_ + col)];
  }

  /// Counts the second differences of one frequency in one direction.
  void add(const ImageF& phase, const ImageF& amplitude, double scale, Eigen::Index step_row,
           Eigen::Index step_col) {
    const auto width = static_cast<std::size_t>(phase.cols());
    std::vector<float> cycles(width);
    std::vector<float> sigma(width);
    std::vector<float> present(width);
    std::vector<float> below_half(width);
    std::vector<float> below_most(width);
    // Of 8000 differences in a direction some 300 are in a block, which tell its noise to a tenth.
    constexpr Eigen::Index enough = 8000;
    const Eigen::Index step = std::max<Eigen::Index>(1, phase.size() / enough);
    for (Eigen::Index v = 0; v < phase.rows(); v += step) {
      const int count = find_differences(phase, amplitude, second_difference, v, step_row, step_col,
                                         cycles.data(), sigma.data());
      compare(count, cycles.data(), sigma.data(), static_cast<float>(scale), present.data(),
              below_half.data(), below_most.data());
      for (int i = 0; i < count; ++i) {
        const Eigen::Index block = (v / block_px) * cols_ + i / block_px;
        Shares& shares = shares_[static_cast<std::size_t>(block)];
        const auto at = static_cast<std::size_t>(i);
        shares.all += present[at];
        shares.below_half += below_half[at];
        shares.below_most += below_most[at];
      }
    }
  }

 private:
  Eigen::Index rows_;
  Eigen::Index cols_;
  std::vector<Shares> shares_;
};

/// The share of numbers below a limit that are normal with the standard deviation `sigma`.
double share_below(double limit, double sigma) {
  return std::erf(limit / (sigma * std::numbers::sqrt2));
}

/// The sigma at which a falling function of it takes a value, 0.1 … 10.
template <class Function>
double solve(const Function& function, double value) {
  double low = 0.1;
  double high = 10;
  constexpr int bisections = 20;
  for (int i = 0; i < bisections; ++i) {
    const double middle = std::sqrt(low * high);
    (function(middle) > value ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

/// The factor of a block's noise; 1 where nothing else is certain.
double factor_of(const Shares& shares) {
  constexpr float enough = 60;
  constexpr double certain = 1.4;     // more than chance and curved surfaces make of it
  constexpr double flat_ratio = 0.3;  // from here on the ratio does not tell edges apart
  if (shares.all < enough) return 1;
  const double below_half = shares.below_half / shares.all;
  const double by_half =
      solve([](double sigma) { return share_below(half_sigmas, sigma); }, below_half);
  if (by_half < 1) return by_half < 1 / certain ? by_half : 1;
  // Differences across edges lie above both limits, and leave the ratio of the shares as it is.
  const double ratio = shares.below_half / std::max(shares.below_most, 1.0F);
  const double by_ratio = ratio < flat_ratio ? by_half
                                             : solve(
                                                   [](double sigma) {
                                                     return share_below(half_sigmas, sigma) /
                                                            share_below(most_sigmas, sigma);
                                                   },
                                                   ratio);
  const double factor = std::min(by_half, by_ratio);
  return factor > certain ? factor : 1;
}

/// Bilinear between the centres of blocks.
ImageF interpolated(const ImageF& blocks, Eigen::Index rows, Eigen::Index cols) {
  ImageF out(rows, cols);
  const auto place = [](Eigen::Index pixel, Eigen::Index count) {
    const float at = (static_cast<float>(pixel) + 0.5F) / block_px - 0.5F;
    return std::clamp(at, 0.0F, static_cast<float>(count - 1));
  };
  for (Eigen::Index v = 0; v < rows; ++v) {
    const float y = place(v, blocks.rows());
    const auto row = static_cast<Eigen::Index>(y);
    const Eigen::Index next_row = std::min(row + 1, blocks.rows() - 1);
    const float down = y - static_cast<float>(row);
    for (Eigen::Index u = 0; u < cols; ++u) {
      const float x = place(u, blocks.cols());
      const auto col = static_cast<Eigen::Index>(x);
      const Eigen::Index next_col = std::min(col + 1, blocks.cols() - 1);
      const float right = x - static_cast<float>(col);
      out(v, u) = (1 - down) * ((1 - right) * blocks(row, col) + right * blocks(row, next_col)) +
                  down * ((1 - right) * blocks(next_row, col) + right * blocks(next_row, next_col));
    }
  }
  return out;
}

}  // namespace

ImageF find_ambient_noise(const DualFrequencyFrame& frame, const PhaseNoise& noise) {
  BlockShares shares(frame.phase_a.rows(), frame.phase_a.cols());
  shares.add(frame.phase_a, frame.amplitude_a, noise.scale_a, 0, 1);
  shares.add(frame.phase_a, frame.amplitude_a, noise.scale_a, 1, 0);
  shares.add(frame.phase_b, frame.amplitude_b, noise.scale_b, 0, 1);
  shares.add(frame.phase_b, frame.amplitude_b, noise.scale_b, 1, 0);
  ImageF logarithms(shares.rows(), shares.cols());
  for (Eigen::Index r = 0; r < logarithms.rows(); ++r) {
    for (Eigen::Index c = 0; c < logarithms.cols(); ++c) {
      logarithms(r, c) = static_cast<float>(std::log(factor_of(shares(r, c))));
    }
  }
  if ((logarithms == 0).all()) return {};
  return interpolated(logarithms, frame.phase_a.rows(), frame.phase_a.cols()).exp();
}

}  // namespace tofmap

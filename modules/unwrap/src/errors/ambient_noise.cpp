// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/ambient_noise.hpp"

#include "common/fast_math.hpp"
#include "errors/phase_differences.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Edge length of a block.
constexpr int block_px = 16;

/// The absolute value of a normal variable lies below 0.67 standard deviations with probability
/// 1/2, and below 2.5 nearly always.
constexpr float half_sigmas = 0.6745F;
constexpr float most_sigmas = 2.5F;

/// Differences with more predicted noise, in cycles, are left out: they wrap so often that they
/// look quieter than they are. At the limit, they do so by a factor of 0.88, which factor_of() does
/// not take for a difference.
constexpr float largest_sigma_cycles = 0.4F;

/// Number of differences in one block, and how many of them are below each limit.
struct Shares {
  int all = 0;
  int below_half = 0;
  int below_most = 0;
};

/// Fills flags (1 or 0) for each difference of a row: whether it exists and its noise does not
/// wrap, and whether it is below each limit.
TOFMAP_VECTOR_CLONES void compare(int count, const float* cycles, const float* relative_sigma,
                                  float scale, int* present, int* below_half, int* below_most) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float size = cycles[i] < 0 ? -cycles[i] : cycles[i];
    const float sigma = scale * relative_sigma[i];
    const int is_present = sigma <= largest_sigma_cycles ? 1 : 0;
    present[i] = is_present;
    below_half[i] = size < half_sigmas * sigma ? is_present : 0;
    below_most[i] = size < most_sigmas * sigma ? is_present : 0;
  }
}

/// The Shares of all blocks of an image.
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

  /// Counts the second differences of one frequency in one direction: along rows if `step_col` is
  /// 1, along columns if `step_row` is 1. `scale` is the noise scale c of that frequency.
  void add(const ImageF& phase, const ImageF& amplitude, double scale, Eigen::Index step_row,
           Eigen::Index step_col) {
    const auto width = static_cast<std::size_t>(phase.cols());
    std::vector<float> cycles(width);
    std::vector<float> sigma(width);
    std::vector<int> present(width);
    std::vector<int> below_half(width);
    std::vector<int> below_most(width);
    // With 8000 differences per direction, a block has about 300, and its noise is known to 10 %.
    constexpr Eigen::Index enough = 8000;
    const Eigen::Index step = std::max<Eigen::Index>(1, phase.size() / enough);
    for (Eigen::Index v = 0; v < phase.rows(); v += step) {
      const int count = find_differences(phase, amplitude, second_difference, v, step_row, step_col,
                                         cycles.data(), sigma.data());
      compare(count, cycles.data(), sigma.data(), static_cast<float>(scale), present.data(),
              below_half.data(), below_most.data());
      Shares* block = &shares_[static_cast<std::size_t>(v / block_px * cols_)];
      for (int first = 0; first < count; first += block_px, ++block) {
        const int end = std::min(first + block_px, count);
        const auto sum = [&](const std::vector<int>& flags) {
          return std::accumulate(flags.begin() + first, flags.begin() + end, 0);
        };
        block->all += sum(present);
        block->below_half += sum(below_half);
        block->below_most += sum(below_most);
      }
    }
  }

 private:
  Eigen::Index rows_;
  Eigen::Index cols_;
  std::vector<Shares> shares_;
};

/// Probability that a normal variable with standard deviation `sigma` is below `limit` in absolute
/// value.
double share_below(double limit, double sigma) {
  return std::erf(limit / (sigma * std::numbers::sqrt2));
}

/// Finds the sigma in 0.1 … 10 at which a decreasing function of sigma takes a value, by bisection.
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

/// Estimates m of one block; 1 unless another value is certain.
double factor_of(const Shares& shares) {
  constexpr int enough = 60;
  constexpr double certain = 1.4;     // chance and curved surfaces cause smaller factors
  constexpr double flat_ratio = 0.3;  // below this, the ratio hardly depends on m any more
  if (shares.all < enough) return 1;
  const double below_half = static_cast<double>(shares.below_half) / shares.all;
  static const double if_quieter = share_below(half_sigmas, 1 / certain);
  static const double if_louder = share_below(half_sigmas, certain);
  if (below_half <= if_quieter && below_half >= if_louder) return 1;
  const double by_half =
      solve([](double sigma) { return share_below(half_sigmas, sigma); }, below_half);
  if (by_half < 1) return by_half;
  // Differences across edges lie above both limits, so they do not change the ratio of the shares.
  const double ratio = static_cast<double>(shares.below_half) / std::max(shares.below_most, 1);
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

/// Interpolation between block centres for one pixel of a row or column.
struct Between {
  Eigen::Index before;  ///< block whose centre lies before the pixel
  Eigen::Index after;   ///< block whose centre lies after the pixel
  float share;          ///< weight of the block `after`, 0 … 1

  Between(Eigen::Index pixel, Eigen::Index blocks) {
    const Eigen::Index shifted = pixel + block_px / 2;
    after = std::min(shifted / block_px, blocks - 1);
    before = std::max<Eigen::Index>(shifted / block_px - 1, 0);
    share = (static_cast<float>(shifted % block_px) + 0.5F) / block_px;
  }
};

/// Interpolates logarithms linearly along a row of pixels and takes their exponential.
TOFMAP_VECTOR_CLONES void fill_factors(int cols, const float* before, const float* after,
                                       const float* share, float* factors) {
#pragma GCC ivdep
  for (int i = 0; i < cols; ++i) {
    const float logarithm = before[i] + share[i] * (after[i] - before[i]);
    const float lesser = exp_of_negative(logarithm < 0 ? logarithm : -logarithm);
    factors[i] = logarithm < 0 ? lesser : 1 / lesser;
  }
}

/// Interpolates the blocks' logarithms bilinearly between block centres and takes their
/// exponential.
ImageF exp_between(const ImageF& blocks, Eigen::Index rows, Eigen::Index cols) {
  ImageF out(rows, cols);
  std::vector<Between> across;
  Eigen::ArrayXf share(cols);
  for (Eigen::Index u = 0; u < cols; ++u) {
    share[u] = across.emplace_back(u, blocks.cols()).share;
  }
  Eigen::ArrayXf before(cols);
  Eigen::ArrayXf after(cols);
  for (Eigen::Index v = 0; v < rows; ++v) {
    const Between along(v, blocks.rows());
    const Eigen::ArrayXf row = (1 - along.share) * blocks.row(along.before).transpose() +
                               along.share * blocks.row(along.after).transpose();
    for (Eigen::Index u = 0; u < cols; ++u) {
      const Between& place = across[static_cast<std::size_t>(u)];
      before[u] = row[place.before];
      after[u] = row[place.after];
    }
    fill_factors(static_cast<int>(cols), before.data(), after.data(), share.data(),
                 out.data() + v * cols);
  }
  return out;
}

}  // namespace

ImageF find_ambient_noise(const Frame& frame, const std::vector<PhaseNoise>& noise) {
  BlockShares shares(frame.rows(), frame.cols());
  const ImageF none;
  for (std::size_t f = 0; f < frame.frequencies(); ++f) {
    const ImageF& amplitude = frame.has_amplitude() ? frame.amplitudes[f] : none;
    shares.add(frame.phases[f], amplitude, noise[f].scale, 0, 1);
    shares.add(frame.phases[f], amplitude, noise[f].scale, 1, 0);
  }
  ImageF logarithms(shares.rows(), shares.cols());
  for (Eigen::Index r = 0; r < logarithms.rows(); ++r) {
    for (Eigen::Index c = 0; c < logarithms.cols(); ++c) {
      logarithms(r, c) = static_cast<float>(std::log(factor_of(shares(r, c))));
    }
  }
  if ((logarithms == 0).all()) return {};
  return exp_between(logarithms, frame.rows(), frame.cols());
}

}  // namespace tofmap

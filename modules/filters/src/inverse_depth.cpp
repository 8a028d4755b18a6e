// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "inverse_depth.hpp"

#include "size_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Lower limit of the standard deviation of a range, relative to the range: 0.1 mm per metre.
constexpr float least_relative_sigma = 1e-4F;

/// Lower limit of the confidence in weights.
constexpr float least_trust = 0.01F;

/// One row of a RangeImage and of its rays.
struct RangeRow {
  const float* range_m;
  const float* sigma_m;
  const float* confidence;
  const float* ray_z;
};

TOFMAP_VECTOR_CLONES void fill_inverse(int pixels, const RangeRow& from_, float* value,
                                       float* variance, float* weight) {
  const RangeRow from = from_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float depth_m = from.range_m[i] * from.ray_z[i];
    const float relative = from.sigma_m[i] / from.range_m[i];
    const float sigma = relative > least_relative_sigma ? relative : least_relative_sigma;
    const float confidence = from.confidence[i];
    const float depth_variance = sigma * sigma * depth_m * depth_m;
    // The mean of 1 / (z + noise) exceeds 1 / z by the factor 1 + (sigma / z)², as long as that is
    // close to 1.
    value[i] = 1 / (depth_m * (1 + sigma * sigma));
    variance[i] = depth_variance;
    weight[i] = (confidence > least_trust ? confidence : least_trust) / depth_variance;
  }
}

/// Sums over the pixel itself and its pairs, for each pixel of a row.
struct Sums {
  std::vector<float> value;  ///< weighted
  std::vector<float> weight;
  std::vector<float> variance;  ///< weighted by the square of the weight

  explicit Sums(int cols)
      : value(static_cast<std::size_t>(cols)), weight(value.size()), variance(value.size()) {}
};

/// One row of an InverseDepth, from some pixel on.
struct DepthRow {
  const float* value;
  const float* variance;
  const float* weight;
};

TOFMAP_VECTOR_CLONES void begin_sums(int pixels, const DepthRow& own_, float* value, float* weight,
                                     float* variance) {
  const DepthRow own = own_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    value[i] = own.weight[i] * own.value[i];
    weight[i] = own.weight[i];
    variance[i] = own.weight[i] * own.weight[i] * own.variance[i];
  }
}

/// The two opposite neighbours of each pixel of a row.
struct PairRow {
  DepthRow one;
  DepthRow other;
};

/// Limits of PairAverage, squared.
struct SquaredLimits {
  float sigmas;
  float tolerance;
};

/// The mean and half the difference of one pair, the variance of either, and the weight of the pair
/// in averages.
struct Pair {
  float mean;
  float half_difference;
  float variance;
  float weight;

  [[gnu::always_inline]] Pair(const PairRow& row, int i)
      : mean(0.5F * (row.one.value[i] + row.other.value[i])),
        half_difference(0.5F * (row.one.value[i] - row.other.value[i])),
        variance(0.25F * (row.one.variance[i] + row.other.variance[i])),
        weight(4 * row.one.weight[i] * row.other.weight[i] /
               (row.one.weight[i] + row.other.weight[i])) {}
};

/// 1 minus the squared deviation `off` of an inverse depth over the tolerated squared deviation;
/// negative if `off` exceeds the limits. The variance of an inverse depth q is q⁴ times the
/// variance of the depth. The smaller q of the two pixels is used: the q of a very near pixel would
/// tolerate pixels that are far away.
[[gnu::always_inline]] inline float room_for(float off, float depth_variance, float value,
                                             float other_value, const SquaredLimits& limits) {
  const float square = value * value;
  const float other_square = other_value * other_value;
  const float least = square < other_square ? square : other_square;
  return 1 - off * off / ((limits.sigmas * depth_variance + limits.tolerance) * least * least);
}

/// Adds the means of the two pairs along an axis, one and two pixels away, as far as they agree
/// with the pixel. On a plane the two pixels of the farther pair differ by twice as much as those
/// of the nearer pair. Across an edge both pairs differ by the same amount (`bend` is not zero).
/// This shows the edge even if the pixel's own noise hides that the means of the pairs lie between
/// the two surfaces.
TOFMAP_VECTOR_CLONES void add_axis(int pixels, const DepthRow& own_, const PairRow& near_,
                                   const PairRow& far_, const SquaredLimits& limits_, float* value,
                                   float* weight, float* variance) {
  const DepthRow own = own_;
  const PairRow near_row = near_;
  const PairRow far_row = far_;
  const SquaredLimits limits = limits_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const Pair near(near_row, i);
    const Pair far(far_row, i);
    const float own_value = own.value[i];
    const float bend = near.half_difference - 0.5F * far.half_difference;
    const float bend_noise = near.variance + 0.25F * far.variance;
    const float bend_room = room_for(bend, bend_noise, own_value, near.mean, limits);
    const float near_room = room_for(near.mean - own_value, own.variance[i] + near.variance,
                                     own_value, near.mean, limits);
    const float far_room =
        room_for(far.mean - own_value, own.variance[i] + far.variance, own_value, far.mean, limits);
    const bool near_agrees = bend_room > 0 && near_room > 0;
    const bool far_agrees = bend_room > 0 && far_room > 0;
    const float near_weight = near_agrees ? near.weight * near_room * near_room : 0.0F;
    const float far_weight = far_agrees ? far.weight * far_room * far_room : 0.0F;
    const float near_value = near_agrees ? near.mean : 0.0F;
    const float far_value = far_agrees ? far.mean : 0.0F;
    const float near_variance = near_agrees ? near.variance : 0.0F;
    const float far_variance = far_agrees ? far.variance : 0.0F;
    value[i] += near_weight * near_value + far_weight * far_value;
    weight[i] += near_weight + far_weight;
    variance[i] +=
        near_weight * near_weight * near_variance + far_weight * far_weight * far_variance;
  }
}

TOFMAP_VECTOR_CLONES void end_sums(int pixels, const float* value, const float* weight,
                                   const float* variance, float* out_value, float* out_variance) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    out_value[i] = value[i] / weight[i];
    out_variance[i] = variance[i] / (weight[i] * weight[i]);
  }
}

}  // namespace

InverseDepth::InverseDepth(Eigen::Index rows, Eigen::Index cols)
    : rows_(static_cast<int>(rows)),
      cols_(static_cast<int>(cols)),
      values_(static_cast<std::size_t>((rows_ + 2 * margin) * stride()), nan),
      variances_(values_),
      weights_(values_) {}

InverseDepth::InverseDepth(const RangeImage& image, const PixelRays& rays)
    : InverseDepth(image.rows(), image.cols()) {
  check_size(image, rays, "filter");
  for (int v = 0; v < rows_; ++v) {
    const Eigen::Index first = v * image.cols();
    fill_inverse(cols_,
                 {image.range_m.data() + first, image.sigma_m.data() + first,
                  image.confidence.data() + first, rays.z.data() + first},
                 value(v), variance(v), weight(v));
  }
}

InverseDepth averaged_over_pairs(const InverseDepth& depth, const PairAverage& options) {
  const SquaredLimits limits{static_cast<float>(options.max_sigmas * options.max_sigmas),
                             static_cast<float>(options.tolerance_m * options.tolerance_m)};
  const int below = depth.stride();
  const std::array<int, 4> axes{1, below - 1, below, below + 1};
  InverseDepth out(depth.rows(), depth.cols());
  Sums sums(depth.cols());
  for (int v = 0; v < depth.rows(); ++v) {
    const auto row_at = [&](int offset) {
      return DepthRow{depth.value(v) + offset, depth.variance(v) + offset,
                      depth.weight(v) + offset};
    };
    const auto pair_at = [&](int offset) { return PairRow{row_at(offset), row_at(-offset)}; };
    const DepthRow own = row_at(0);
    begin_sums(depth.cols(), own, sums.value.data(), sums.weight.data(), sums.variance.data());
    for (const int axis : axes) {
      add_axis(depth.cols(), own, pair_at(axis), pair_at(2 * axis), limits, sums.value.data(),
               sums.weight.data(), sums.variance.data());
    }
    end_sums(depth.cols(), sums.value.data(), sums.weight.data(), sums.variance.data(),
             out.value(v), out.variance(v));
  }
  return out;
}

}  // namespace tofmap

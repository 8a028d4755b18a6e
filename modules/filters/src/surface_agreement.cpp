// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "surface_agreement.hpp"

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

constexpr auto directions = static_cast<std::size_t>(Neighbourhood::directions);
constexpr auto axes = static_cast<std::size_t>(Neighbourhood::axes);

/// The pixels of a row: inverse depths, which are not averaged, and frequency differences.
struct OwnRow {
  const float* value;
  const float* variance;
  const float* difference;
  const float* difference_variance;
};

/// The next and the second next pixel in one direction, for each pixel of a row. Inverse depths are
/// averaged over pairs, frequency differences are not.
struct DirectionRow {
  const float* next;
  const float* next_variance;
  const float* second;
  const float* second_variance;
  const float* next_difference;
  const float* next_difference_variance;
  const float* second_difference;
  const float* second_difference_variance;
};

/// Deviations of the pixels of a row from the predictions of one direction: of the depth (positive
/// towards the camera) and of the frequency difference, metres, with the variances of the
/// predictions.
template <class Number>
struct OffsetRow {
  Number* depth;
  Number* variance;
  Number* difference;
  Number* difference_variance;
};

/// Squares of AgreementLimits, and of limits that follow from them.
struct SquaredLimits {
  float plane;
  float same;  ///< for a single direction at a step, and for pixels that cannot be a mixture
  float edge;
  float step;
  float tolerance;
  float mixing;
};

/// Squared deviations of the depth of a pixel from a surface, from both frequencies and from A
/// alone, with their variances.
struct Offsets {
  float fused;
  float fused_variance;
  float a;
  float a_variance;

  /// The depth from A is the fused depth plus half the frequency difference; `depth` counts towards
  /// the camera.
  [[gnu::always_inline]] Offsets(float depth, float variance, float difference,
                                 float difference_variance)
      : fused(depth * depth),
        fused_variance(variance),
        a((depth - 0.5F * difference) * (depth - 0.5F * difference)),
        a_variance(variance + 0.25F * difference_variance) {}

  [[gnu::always_inline]] bool within(float sigmas2, float tolerance2) const {
    return (fused <= sigmas2 * fused_variance + tolerance2) &
           (a <= sigmas2 * a_variance + tolerance2);
  }
};

constexpr unsigned same_shift = Neighbourhood::directions;
constexpr unsigned line_shift = 2 * Neighbourhood::directions;

/// Compares each pixel with the prediction of one direction (docs/filters.md, equations 2 to 4),
/// and sets a bit for each of the limits `plane`, `same` and `edge` within which they agree.
TOFMAP_VECTOR_CLONES void predict(int pixels, const OwnRow& own_, const DirectionRow& from_,
                                  const SquaredLimits& limits_, unsigned bit,
                                  const OffsetRow<float>& out_, unsigned* agrees) {
  const OwnRow own = own_;
  const DirectionRow from = from_;
  const SquaredLimits limits = limits_;
  const OffsetRow<float> out = out_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float predicted = 2 * from.next[i] - from.second[i];
    const float depth = (own.value[i] - predicted) / (predicted * predicted);
    const float variance = 4 * from.next_variance[i] + from.second_variance[i];
    const float difference =
        own.difference[i] - 0.5F * (from.next_difference[i] + from.second_difference[i]);
    const float difference_variance =
        0.25F * (from.next_difference_variance[i] + from.second_difference_variance[i]);
    out.depth[i] = depth;
    out.variance[i] = variance;
    out.difference[i] = difference;
    out.difference_variance[i] = difference_variance;
    const Offsets off(depth, own.variance[i] + variance, difference,
                      own.difference_variance[i] + difference_variance);
    const unsigned on_plane = off.within(limits.plane, limits.tolerance) ? bit : 0U;
    const unsigned on_same = off.within(limits.same, limits.tolerance) ? bit << same_shift : 0U;
    const unsigned on_line = off.within(limits.edge, limits.tolerance) ? bit << line_shift : 0U;
    agrees[i] |= on_plane | on_same | on_line;
  }
}

/// Sets the bit where the opposite sides of the pixel are two surfaces: the two sides predict
/// different depths for the pixel, and neither side predicts the nearest pixel of the other side.
TOFMAP_VECTOR_CLONES void find_steps(int pixels, const DirectionRow& one_,
                                     const DirectionRow& other_, const SquaredLimits& limits_,
                                     unsigned bit, unsigned* sectors) {
  const DirectionRow one = one_;
  const DirectionRow other = other_;
  const SquaredLimits limits = limits_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float by_one = 2 * one.next[i] - one.second[i];
    const float by_other = 2 * other.next[i] - other.second[i];
    const float one_to_other = 3 * one.next[i] - 2 * one.second[i] - other.next[i];
    const float other_to_one = 3 * other.next[i] - 2 * other.second[i] - one.next[i];
    const float one_variance = one.next_variance[i];
    const float other_variance = other.next_variance[i];
    const float one_second = one.second_variance[i];
    const float other_second = other.second_variance[i];
    const float far = by_one < by_other ? by_one : by_other;
    const float scale = far * far * far * far;
    const auto tolerated = [&](float variance) {
      return (limits.step * variance + limits.tolerance) * scale;
    };
    const float gap = by_one - by_other;
    const bool differ =
        gap * gap > tolerated(4 * (one_variance + other_variance) + one_second + other_second);
    const bool one_ends =
        one_to_other * one_to_other > tolerated(9 * one_variance + 4 * one_second + other_variance);
    const bool other_ends = other_to_one * other_to_one >
                            tolerated(9 * other_variance + 4 * other_second + one_variance);
    sectors[i] |= (differ & one_ends & other_ends) ? bit : 0U;
  }
}

/// Deviations from the predictions of three adjacent directions, and from that of the direction
/// opposite to the middle one.
struct SectorRow {
  OffsetRow<const float> left;
  OffsetRow<const float> middle;
  OffsetRow<const float> right;
  OffsetRow<const float> opposite;
};

/// Sets the bit where the pixel agrees with the mean of the predictions of three directions. The
/// limit is wider for a pixel that cannot be a mixture of that surface and the opposite one,
/// because it does not lie between them and they are closer than the mixing limit.
TOFMAP_VECTOR_CLONES void judge_sector(int pixels, const OwnRow& own_, const SectorRow& sector_,
                                       const SquaredLimits& limits_, unsigned bit,
                                       unsigned* sectors) {
  // The averages over pairs share pixels, so the variance of the mean of three predictions is
  // larger than that of independent ones.
  constexpr float shared = 2;
  constexpr float least_variance = 1e-8F;
  const OwnRow own = own_;
  const SectorRow sector = sector_;
  const SquaredLimits limits = limits_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float left = 1 / (sector.left.variance[i] + least_variance);
    const float middle = 1 / (sector.middle.variance[i] + least_variance);
    const float right = 1 / (sector.right.variance[i] + least_variance);
    const float weight = left + middle + right;
    const float depth = (left * sector.left.depth[i] + middle * sector.middle.depth[i] +
                         right * sector.right.depth[i]) /
                        weight;
    const float difference =
        (sector.left.difference[i] + sector.middle.difference[i] + sector.right.difference[i]) / 3;
    const float difference_variance =
        (sector.left.difference_variance[i] + sector.middle.difference_variance[i] +
         sector.right.difference_variance[i]) /
        9;
    const float opposite = sector.opposite.depth[i];
    const float gap = opposite - depth;
    const bool is_beyond = (depth * opposite > 0) & (depth * depth < opposite * opposite) &
                           (gap * gap < limits.mixing);
    const Offsets off(depth, own.variance[i] + shared / weight, difference,
                      own.difference_variance[i] + difference_variance);
    const bool agrees = off.within(is_beyond ? limits.same : limits.edge, limits.tolerance);
    sectors[i] |= agrees ? bit : 0U;
  }
}

/// The directions, one bit each, that are in the middle of three adjacent directions which agree
/// with the pixel.
[[gnu::always_inline]] inline unsigned surfaces_of(unsigned agrees, unsigned sectors, bool at_step,
                                                   unsigned among) {
  const unsigned bits = (at_step ? agrees >> same_shift : agrees) & among;
  const unsigned twice = bits | bits << Neighbourhood::directions;
  const unsigned threes = twice << 1 & twice & twice >> 1;
  const unsigned middles = (threes | threes >> Neighbourhood::directions) & Neighbourhood::all;
  return at_step ? middles & sectors : middles;
}

/// Sets `surface_bit` where the pixel lies on some surface.
TOFMAP_VECTOR_CLONES void find_surfaces(int pixels, const unsigned* agrees, unsigned step_bit,
                                        unsigned surface_bit, unsigned* sectors) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const bool at_step = (sectors[i] & step_bit) != 0;
    const unsigned found = surfaces_of(agrees[i], sectors[i], at_step, Neighbourhood::all);
    sectors[i] |= found != 0 ? surface_bit : 0U;
  }
}

float squared(double number) { return static_cast<float>(number * number); }

SquaredLimits squared_limits(const AgreementLimits& limits) {
  constexpr double same_sigmas = 1.75;  // relative to edge_sigmas
  constexpr double step_sigmas = 2;
  return {.plane = squared(limits.plane_sigmas),
          .same = squared(same_sigmas * limits.edge_sigmas),
          .edge = squared(limits.edge_sigmas),
          .step = squared(step_sigmas),
          .tolerance = squared(limits.tolerance_m),
          .mixing = squared(limits.mixing_m)};
}

/// Memory for the deviations of a row from the predictions of all directions.
class OffsetBuffers {
 public:
  explicit OffsetBuffers(int cols)
      : cols_(static_cast<std::size_t>(cols)), numbers_(4 * directions * cols_) {}

  OffsetRow<float> operator[](std::size_t direction) {
    float* first = numbers_.data() + 4 * (direction % directions) * cols_;
    return {first, first + cols_, first + 2 * cols_, first + 3 * cols_};
  }
  OffsetRow<const float> get(std::size_t direction) {
    const OffsetRow<float> row = (*this)[direction];
    return {row.depth, row.variance, row.difference, row.difference_variance};
  }

 private:
  std::size_t cols_;
  std::vector<float> numbers_;
};

DirectionRow direction_row(const Depths& depths, int row, std::size_t direction) {
  const int step = Neighbourhood::offset(direction, depths.own.stride());
  const float* value = depths.smooth.value(row) + step;
  const float* variance = depths.smooth.variance(row) + step;
  const float* difference = depths.difference.value(row) + step;
  const float* difference_variance = depths.difference.variance(row) + step;
  return {value,
          variance,
          value + step,
          variance + step,
          difference,
          difference_variance,
          difference + step,
          difference_variance + step};
}

}  // namespace

SurfaceAgreement::SurfaceAgreement(const Depths& depths, const AgreementLimits& limits)
    : stride_(depths.own.stride()),
      agrees_(static_cast<std::size_t>((depths.own.rows() + 2 * margin) * stride_)),
      sectors_(agrees_.size()) {
  const SquaredLimits squares = squared_limits(limits);
  const int cols = depths.own.cols();
  OffsetBuffers offsets(cols);
  for (int v = 0; v < depths.own.rows(); ++v) {
    const OwnRow own{depths.own.value(v), depths.own.variance(v), depths.difference.value(v),
                     depths.difference.variance(v)};
    unsigned* agrees = agrees_.data() + place(v, 0);
    unsigned* sectors = sectors_.data() + place(v, 0);
    for (std::size_t d = 0; d < directions; ++d) {
      predict(cols, own, direction_row(depths, v, d), squares, 1U << d, offsets[d], agrees);
    }
    for (std::size_t d = 0; d < axes; ++d) {
      find_steps(cols, direction_row(depths, v, d), direction_row(depths, v, d + axes), squares,
                 step_bit, sectors);
    }
    for (std::size_t d = 0; d < directions; ++d) {
      const SectorRow sector{offsets.get(d + directions - 1), offsets.get(d), offsets.get(d + 1),
                             offsets.get(d + axes)};
      judge_sector(cols, own, sector, squares, 1U << d, sectors);
    }
    find_surfaces(cols, agrees, step_bit, surface_bit, sectors);
  }
}

bool SurfaceAgreement::lies_on_surface(int row, int col, unsigned among) const {
  const std::size_t at = place(row, col);
  return surfaces_of(agrees_[at], sectors_[at], is_at_step(row, col), among) != 0;
}

unsigned SurfaceAgreement::lines(int row, int col) const {
  const unsigned bits = agrees_[place(row, col)] >> line_shift;
  return bits & bits >> axes;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plane_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Pixels of a row, starting at some column.
struct Pixels {
  const float* q;
  const float* variance;
  const float* x;
  const float* y;

  Pixels at(std::ptrdiff_t offset) const {
    return {q + offset, variance + offset, x + offset, y + offset};
  }
};

/// `Count` values for each pixel of a row.
template <std::size_t Count>
class RowValues {
 public:
  explicit RowValues(std::size_t cols) {
    for (auto& values : values_) values.resize(cols);
  }
  void set_zero() {
    for (auto& values : values_) std::ranges::fill(values, 0.0F);
  }
  float* operator[](std::size_t i) { return values_[i].data(); }

 private:
  std::array<std::vector<float>, Count> values_;
};

/// Sums for fitting a line through each pixel to its neighbours on one side.
struct LineSums {
  float* xx;
  float* xq;
  float* qq;
  float* count;    ///< number of neighbours before the first one without a value
  float* is_open;  ///< 1 until a neighbour has no value, then 0
};

/// Adds the next neighbour on one side. `own_along` and `next_along` are the tangents on the axis
/// of the line.
TOFMAP_VECTOR_CLONES void add_to_line(int pixels, const Pixels& own_, const Pixels& next_,
                                      const float* own_along, const float* next_along,
                                      const LineSums& sums_) {
  const Pixels own = own_;
  const Pixels next = next_;
  const LineSums sums = sums_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float d = next.q[i] - own.q[i];
    const bool is_usable = sums.is_open[i] > 0 && d == d;
    const float x = next_along[i] - own_along[i];
    const float weight = is_usable ? 1 / (next.variance[i] + own.variance[i]) : 0.0F;
    const float usable_d = is_usable ? d : 0.0F;
    sums.xx[i] += weight * x * x;
    sums.xq[i] += weight * x * usable_d;
    sums.qq[i] += weight * usable_d * usable_d;
    sums.count[i] += is_usable ? 1.0F : 0.0F;
    sums.is_open[i] = is_usable ? 1.0F : 0.0F;
  }
}

/// The slope of a line and its variance.
struct Slopes {
  float* slope;
  float* variance;
};

/// The line fitted to one side.
struct Side {
  float slope;
  float variance;
  float badness;  ///< scatter about the line times the magnitude of the slope
  bool is_usable;

  [[gnu::always_inline]] Side(const LineSums& sums, int i)
      : slope(0), variance(0), badness(0), is_usable(sums.count[i] > 0) {
    const float inverse = is_usable ? 1 / sums.xx[i] : 0.0F;
    slope = sums.xq[i] * inverse;
    variance = inverse;
    const float others = sums.count[i] - 1;
    const float rest = sums.qq[i] - sums.xq[i] * slope;
    const float scatter = others > 0 ? rest / others : 1.0F;
    badness = (scatter > 1 ? scatter : 1.0F) * (slope < 0 ? -slope : slope);
  }
};

/// Slopes along an axis: the weighted mean of both sides where they agree, otherwise the slope of
/// the side with less badness, since the other one crosses an edge.
TOFMAP_VECTOR_CLONES void choose_slopes(int pixels, const LineSums& back_, const LineSums& front_,
                                        const Slopes& out_) {
  const LineSums back_sums = back_;
  const LineSums front_sums = front_;
  const Slopes out = out_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const Side back(back_sums, i);
    const Side front(front_sums, i);
    const float difference = back.slope - front.slope;
    const float sum = back.variance + front.variance;
    const float share = sum > 0 ? front.variance / sum : 0.0F;  // weights by inverse variance
    const bool agree = difference * difference < 4 * sum;
    const bool take_back = !front.is_usable || (back.is_usable && back.badness <= front.badness);
    const float better_slope = take_back ? back.slope : front.slope;
    const float better_variance = take_back ? back.variance : front.variance;
    const bool take_both = back.is_usable && front.is_usable && agree;
    out.slope[i] = take_both ? share * back.slope + (1 - share) * front.slope : better_slope;
    out.variance[i] = take_both ? back.variance * share : better_variance;
  }
}

/// The current planes, which neighbours must be near. `slack` are the variances of an initial
/// plane, which are tolerated in addition to the variance of a neighbour.
struct Planes {
  float* offset;  ///< q of the plane at the pixel minus q of the pixel
  float* a;
  float* b;
  float* slack;    ///< variance of q
  float* slack_a;  ///< variance of a
  float* slack_b;  ///< variance of b
};

/// Weighted sums over neighbours.
struct Sums {
  float* count;
  float* s;
  float* sx;
  float* sy;
  float* sxx;
  float* sxy;
  float* syy;
  float* sq;
  float* sxq;
  float* syq;
  float* sqq;
};

/// Neighbours that are added together, so that sums are loaded and stored once for them.
constexpr int neighbours_at_once = 3;

/// Adds `Count` neighbours of each pixel, from `first_` to the right, if they are near the plane of
/// the pixel.
template <int Count>
[[gnu::always_inline]] inline void add_neighbours(int pixels, const Pixels& own_,
                                                  const Pixels& first_, const Planes& planes_,
                                                  float gate2, const Sums& sums_) {
  const Pixels own = own_;
  const Pixels first = first_;
  const Planes planes = planes_;
  const Sums sums = sums_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    float count = sums.count[i];
    float s = sums.s[i];
    float sx = sums.sx[i];
    float sy = sums.sy[i];
    float sxx = sums.sxx[i];
    float sxy = sums.sxy[i];
    float syy = sums.syy[i];
    float sq = sums.sq[i];
    float sxq = sums.sxq[i];
    float syq = sums.syq[i];
    float sqq = sums.sqq[i];
#pragma GCC unroll neighbours_at_once
    for (int k = 0; k < Count; ++k) {
      const float x = first.x[i + k] - own.x[i];
      const float y = first.y[i + k] - own.y[i];
      const float d = first.q[i + k] - own.q[i];  // NaN fails the gate below
      const float variance = first.variance[i + k];
      const float error = d - planes.offset[i] - planes.a[i] * x - planes.b[i] * y;
      const float tolerated = gate2 * (variance + planes.slack[i] + planes.slack_a[i] * x * x +
                                       planes.slack_b[i] * y * y);
      const bool is_near = error * error < tolerated;
      const float weight = is_near ? 1 / variance : 0.0F;
      const float near_d = is_near ? d : 0.0F;
      const float wx = weight * x;
      const float wy = weight * y;
      const float wd = weight * near_d;
      count += is_near ? 1.0F : 0.0F;
      s += weight;
      sx += wx;
      sy += wy;
      sxx += wx * x;
      sxy += wx * y;
      syy += wy * y;
      sq += wd;
      sxq += wd * x;
      syq += wd * y;
      sqq += wd * near_d;
    }
    sums.count[i] = count;
    sums.s[i] = s;
    sums.sx[i] = sx;
    sums.sy[i] = sy;
    sums.sxx[i] = sxx;
    sums.sxy[i] = sxy;
    sums.syy[i] = syy;
    sums.sq[i] = sq;
    sums.sxq[i] = sxq;
    sums.syq[i] = syq;
    sums.sqq[i] = sqq;
  }
}

/// Adds `count` neighbours of each pixel, from `first` to the right, if they are near the plane of
/// the pixel.
TOFMAP_VECTOR_CLONES void add_row(int pixels, int count, const Pixels& own, const Pixels& first,
                                  const Planes& planes, float gate2, const Sums& sums) {
  int k = 0;
  for (; k + neighbours_at_once <= count; k += neighbours_at_once) {
    add_neighbours<neighbours_at_once>(pixels, own, first.at(k), planes, gate2, sums);
  }
  for (; k < count; ++k) add_neighbours<1>(pixels, own, first.at(k), planes, gate2, sums);
}

/// Results of a fit besides the plane.
struct Fits {
  float* neighbours;  ///< number of pixels in the fit; 0 if they do not span a plane
  float* q0_variance;
  float* a_variance;
  float* b_variance;
  float* excess;
};

/// Solves the normal equations of each pixel by the decomposition L D Lᵀ. They are scaled to a unit
/// diagonal first, since tangents are small numbers. Neighbours whose mean square tangent along an
/// axis is below `least_spread2` are taken to be on one line.
TOFMAP_VECTOR_CLONES void solve(int pixels, const Sums& sums_, float least_spread2,
                                const Planes& planes_, const Fits& fits_) {
  constexpr float least_pivot = 1e-3F;  // smaller if the neighbours are on one line
  const Sums sums = sums_;
  const Planes planes = planes_;
  const Fits fits = fits_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float count = sums.count[i];
    const float least = least_spread2 * sums.s[i];
    const bool spans_axes = count >= 3 && sums.sxx[i] > least && sums.syy[i] > least;
    const float scale0 = spans_axes ? 1 / __builtin_sqrtf(sums.s[i]) : 0.0F;
    const float scale1 = spans_axes ? 1 / __builtin_sqrtf(sums.sxx[i]) : 0.0F;
    const float scale2 = spans_axes ? 1 / __builtin_sqrtf(sums.syy[i]) : 0.0F;
    const float m01 = scale0 * scale1 * sums.sx[i];
    const float m02 = scale0 * scale2 * sums.sy[i];
    const float m12 = scale1 * scale2 * sums.sxy[i];
    const float d1 = 1 - m01 * m01;
    const float l21 = (m12 - m01 * m02) / (d1 > least_pivot ? d1 : 1.0F);
    const float d2 = 1 - m02 * m02 - l21 * l21 * d1;
    const bool spans_plane = spans_axes && d1 > least_pivot && d2 > least_pivot;
    const float safe_d1 = spans_plane ? d1 : 1.0F;
    const float safe_d2 = spans_plane ? d2 : 1.0F;
    // L z = m, D L^T u = z
    const float z0 = scale0 * sums.sq[i];
    const float z1 = scale1 * sums.sxq[i] - m01 * z0;
    const float z2 = scale2 * sums.syq[i] - m02 * z0 - l21 * z1;
    const float u2 = z2 / safe_d2;
    const float u1 = z1 / safe_d1 - l21 * u2;
    const float u0 = z0 - m01 * u1 - m02 * u2;
    // The diagonal of the inverse: L⁻¹ has −m01, m01 l21 − m02 and −l21 below its diagonal.
    const float k20 = m01 * l21 - m02;
    const float inverse0 = 1 + m01 * m01 / safe_d1 + k20 * k20 / safe_d2;
    const float inverse1 = 1 / safe_d1 + l21 * l21 / safe_d2;
    const float inverse2 = 1 / safe_d2;
    const float offset = scale0 * u0;
    const float a = scale1 * u1;
    const float b = scale2 * u2;
    // If the neighbours scatter more than predicted, the variances are increased accordingly.
    const float chi2 = sums.sqq[i] - offset * sums.sq[i] - a * sums.sxq[i] - b * sums.syq[i];
    const float others = count - 3;
    const float scatter = chi2 / (others > 1 ? others : 1.0F);
    const float excess = scatter > 1 ? scatter : 1.0F;
    planes.offset[i] = offset;
    planes.a[i] = a;
    planes.b[i] = b;
    planes.slack[i] = 0;
    planes.slack_a[i] = 0;
    planes.slack_b[i] = 0;
    fits.neighbours[i] = spans_plane ? count : 0.0F;
    fits.excess[i] = excess;
    fits.q0_variance[i] = excess * scale0 * scale0 * inverse0;
    fits.a_variance[i] = excess * scale1 * scale1 * inverse1;
    fits.b_variance[i] = excess * scale2 * scale2 * inverse2;
  }
}

/// Buffers of one row.
struct Workspace {
  RowValues<5> back;
  RowValues<5> front;
  RowValues<6> planes;
  RowValues<11> sums;
  std::vector<float> neighbours;
  std::vector<float> fewest;  ///< smallest number of neighbours of the fits so far

  explicit Workspace(std::size_t cols)
      : back(cols), front(cols), planes(cols), sums(cols), neighbours(cols), fewest(cols) {}
};

LineSums empty_line(RowValues<5>& values, std::size_t cols) {
  values.set_zero();
  std::fill_n(values[4], cols, 1.0F);
  return {values[0], values[1], values[2], values[3], values[4]};
}

}  // namespace

PlaneFits::PlaneFits(const RangeImage& image, const PixelRays& rays, const CloudOptions& options)
    : rows_(static_cast<int>(image.rows())),
      cols_(static_cast<int>(image.cols())),
      margin_(options.window_radius_px),
      stride_(cols_ + 2 * margin_),
      gate2_(static_cast<float>(options.gate_sigmas * options.gate_sigmas)),
      min_neighbours_(options.min_neighbours),
      q_(static_cast<std::size_t>((rows_ + 2 * margin_) * stride_), nan),
      variance_(q_.size(), 1.0F),
      tangent_x_(q_.size(), 0.0F),
      tangent_y_(q_.size(), 0.0F) {
  for (int row = 0; row < rows_; ++row) {
    for (int col = 0; col < cols_; ++col) {
      const std::size_t at = place(row, col);
      const float ray_z = rays.z(row, col);
      tangent_x_[at] = rays.x(row, col) / ray_z;
      tangent_y_[at] = rays.y(row, col) / ray_z;
      if (!image.valid(row, col)) continue;
      const float range_m = image.range_m(row, col);
      const float q = 1 / (range_m * ray_z);
      // dq / dr = −q / r.
      const float q_per_m = q / range_m;
      q_[at] = q;
      variance_[at] = static_cast<float>(image.variance_m2(row, col)) * q_per_m * q_per_m;
    }
  }
  if (rows_ == 0 || cols_ < 2) return;
  // The spread if one of a hundred neighbours is one pixel off the line.
  const float pitch = tangent_x(rows_ / 2, cols_ / 2) - tangent_x(rows_ / 2, cols_ / 2 - 1);
  least_spread2_ = 0.01F * pitch * pitch;
}

void PlaneFits::fit(int row, PlaneRow& out) const {
  const auto cols = static_cast<std::size_t>(cols_);
  thread_local Workspace work(cols);
  if (work.neighbours.size() != cols) work = Workspace(cols);
  const std::size_t first = place(row, 0);
  const Pixels own{q_.data() + first, variance_.data() + first, tangent_x_.data() + first,
                   tangent_y_.data() + first};
  const Planes planes{work.planes[0], work.planes[1], work.planes[2],
                      work.planes[3], work.planes[4], work.planes[5]};
  const Sums sums{work.sums[0], work.sums[1], work.sums[2], work.sums[3],
                  work.sums[4], work.sums[5], work.sums[6], work.sums[7],
                  work.sums[8], work.sums[9], work.sums[10]};

  const auto find_slopes = [&](std::ptrdiff_t step, const float* Pixels::*along,
                               const Slopes& slopes) {
    const LineSums back = empty_line(work.back, cols);
    const LineSums front = empty_line(work.front, cols);
    for (int k = 1; k <= margin_; ++k) {
      const Pixels before = own.at(-k * step);
      const Pixels after = own.at(k * step);
      add_to_line(cols_, own, before, own.*along, before.*along, back);
      add_to_line(cols_, own, after, own.*along, after.*along, front);
    }
    choose_slopes(cols_, back, front, slopes);
  };
  work.planes.set_zero();
  find_slopes(1, &Pixels::x, {planes.a, planes.slack_a});
  find_slopes(stride_, &Pixels::y, {planes.b, planes.slack_b});
  std::copy_n(own.variance, cols, planes.slack);

  constexpr int fits = 3;
  std::ranges::fill(work.fewest, std::numeric_limits<float>::max());
  for (int i = 0; i < fits; ++i) {
    work.sums.set_zero();
    for (int down = -margin_; down <= margin_; ++down) {
      add_row(cols_, 2 * margin_ + 1, own, own.at(down * stride_ - margin_), planes, gate2_, sums);
    }
    solve(cols_, sums, least_spread2_, planes,
          {work.neighbours.data(), out.q0_variance.data(), out.a_variance.data(),
           out.b_variance.data(), out.excess.data()});
    std::ranges::transform(work.fewest, work.neighbours, work.fewest.begin(),
                           [](float one, float other) { return std::min(one, other); });
  }
  for (std::size_t col = 0; col < cols; ++col) {
    const float offset = planes.offset[col];
    // A pixel that is not on its own plane is a flying pixel in front of or behind a surface.
    const bool is_on_it = offset * offset <= gate2_ * own.variance[col];
    const bool has_plane = work.fewest[col] >= static_cast<float>(min_neighbours_) && is_on_it;
    out.neighbours[col] = has_plane ? static_cast<int>(work.neighbours[col]) : 0;
    out.q0[col] = own.q[col] + offset;
    out.a[col] = planes.a[col];
    out.b[col] = planes.b[col];
  }
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "phasor_windows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

constexpr float two_pi = 2 * std::numbers::pi_v<float>;

/// Moments of the unit phasor of a pixel with this phase noise (docs/filters.md, equation 10).
struct PhasorMoments {
  float mean;             ///< R, along the true phase
  float variance_across;  ///< V, across the true phase

  explicit PhasorMoments(float sigma_cycles) {
    constexpr float least_sigma_rad = 0.01F;
    const float sigma = std::max(least_sigma_rad, two_pi * sigma_cycles);
    mean = std::exp(-0.5F * sigma * sigma);
    variance_across = 0.5F * (1 - mean * mean * mean * mean);
  }
};

struct Complex {
  float re;
  float im;
};

[[gnu::always_inline]] inline Complex product(Complex one, Complex other) {
  return {one.re * other.re - one.im * other.im, one.re * other.im + one.im * other.re};
}

/// `one` times the complex conjugate of `by`: rotates `one` back by the phase of `by`.
[[gnu::always_inline]] inline Complex rotated_back(Complex one, Complex by) {
  return {one.re * by.re + one.im * by.im, one.im * by.re - one.re * by.im};
}

[[gnu::always_inline]] inline float dot(Complex one, Complex other) {
  return one.re * other.re + one.im * other.im;
}

/// Phasors of a row, from column `offset` on.
struct PhasorRow {
  const float* re;
  const float* im;

  PhasorRow(const PhasorImage& image, int v, int offset)
      : re(image.re.row(v) + offset), im(image.im.row(v) + offset) {}

  [[gnu::always_inline]] Complex operator[](int i) const { return {re[i], im[i]}; }
};

/// Buffer for the phasors of a row.
class RowPhasors {
 public:
  explicit RowPhasors(int cols) : re_(static_cast<std::size_t>(cols)), im_(re_) {}

  float* re() { return re_.data(); }
  float* im() { return im_.data(); }

 private:
  std::vector<float> re_;
  std::vector<float> im_;
};

/// Unit phasors of the phase that the plane of each pixel of a row adds between the pixel and an
/// offset, for both frequencies.
struct Rotors {
  RowPhasors a;
  RowPhasors b;

  explicit Rotors(int cols) : a(cols), b(cols) {}
};

struct RotorRow {
  float* re;
  float* im;

  explicit RotorRow(RowPhasors& phasors) : re(phasors.re()), im(phasors.im()) {}

  [[gnu::always_inline]] Complex operator[](int i) const { return {re[i], im[i]}; }
};

/// Multiplies each rotor by the corresponding one of `by`.
TOFMAP_VECTOR_CLONES void rotate(int pixels, const RotorRow& rotors_, const RotorRow& by_) {
  const RotorRow rotors = rotors_;
  const RotorRow by = by_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const Complex rotated = product(rotors[i], by[i]);
    rotors.re[i] = rotated.re;
    rotors.im[i] = rotated.im;
  }
}

void rotate(int pixels, Rotors& rotors, Rotors& by) {
  rotate(pixels, RotorRow(rotors.a), RotorRow(by.a));
  rotate(pixels, RotorRow(rotors.b), RotorRow(by.b));
}

/// Sets `out` to the rotors of the offset (x, y). `ratio` is λ_A / λ_B.
void set_rotors(int pixels, const float* slope_x, const float* slope_y, int x, int y, float ratio,
                Rotors& out) {
  for (int i = 0; i < pixels; ++i) {
    const float angle = slope_x[i] * static_cast<float>(x) + slope_y[i] * static_cast<float>(y);
    out.a.re()[i] = std::cos(angle);
    out.a.im()[i] = std::sin(angle);
    out.b.re()[i] = std::cos(ratio * angle);
    out.b.im()[i] = std::sin(ratio * angle);
  }
}

/// Weighted sums of phasors z over windows: of z, x z and y z, where (x, y) is the offset.
struct FrequencySums {
  float *re, *im, *x_re, *x_im, *y_re, *y_im;

  [[gnu::always_inline]] void add(int i, Complex z, float w, float wx, float wy) const {
    re[i] += w * z.re;
    im[i] += w * z.im;
    x_re[i] += wx * z.re;
    x_im[i] += wx * z.im;
    y_re[i] += wy * z.re;
    y_im[i] += wy * z.im;
  }
};

/// Sums over the windows of a row's pixels.
struct SumRow {
  FrequencySums a;
  FrequencySums b;
  float *s, *sx, *sy, *sxx, *sxy, *syy;  ///< weighted information, times products of the offset
  float* s2;                             ///< information times squared weights
};

/// Memory of the sums of a row.
class WindowSums {
 public:
  explicit WindowSums(int cols) {
    for (auto& values : values_) values.resize(static_cast<std::size_t>(cols));
  }

  void set_zero() {
    for (auto& values : values_) std::ranges::fill(values, 0.0F);
  }

  SumRow row() {
    const auto at = [this](std::size_t i) { return values_[i].data(); };
    return {{at(0), at(1), at(2), at(3), at(4), at(5)},
            {at(6), at(7), at(8), at(9), at(10), at(11)},
            at(12),
            at(13),
            at(14),
            at(15),
            at(16),
            at(17),
            at(18)};
  }

 private:
  std::array<std::vector<float>, 19> values_;
};

/// Planes of a row, from column `offset` on.
struct PhasePlaneRow {
  PhasorRow a;
  PhasorRow b;
  const float* variance;
  const float* slope_variance;

  PhasePlaneRow(const PhasePlanes& planes, int v, int offset)
      : a(planes.a, v, offset),
        b(planes.b, v, offset),
        variance(planes.variance.row(v) + offset),
        slope_variance(planes.slope_variance.row(v) + offset) {}
};

/// Measurements of a row, from column `offset` on.
struct MeasuredRow {
  PhasorRow a;
  PhasorRow b;
  const float* information;

  MeasuredRow(const Phasors& phasors, int v, int offset)
      : a(phasors.a, v, offset),
        b(phasors.b, v, offset),
        information(phasors.information.row(v) + offset) {}
};

/// One offset in the window.
struct Place {
  float x;
  float y;
  float weight;
  float inverse_misfit;  ///< 1 / the largest accepted misfit; 0 accepts all pixels
};

/// Adds the pixels at one offset to the windows, weighted by how well their planes agree with the
/// plane of the window's pixel (docs/filters.md, equation 13). The weight is full up to a third of
/// the largest accepted misfit, and falls linearly to 0 at the largest.
TOFMAP_VECTOR_CLONES void add_place(int pixels, const Place& place_, const RotorRow& rotor_a_,
                                    const RotorRow& rotor_b_, const PhasePlaneRow& own_,
                                    const PhasePlaneRow& other_, const MeasuredRow& measured_,
                                    const SumRow& sums_) {
  const Place place = place_;
  const RotorRow rotor_a = rotor_a_;
  const RotorRow rotor_b = rotor_b_;
  const PhasePlaneRow own = own_;
  const PhasePlaneRow other = other_;
  const MeasuredRow measured = measured_;
  const SumRow sums = sums_;
  const float length2 = place.x * place.x + place.y * place.y;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const Complex rotation_a = rotor_a[i];
    const Complex rotation_b = rotor_b[i];
    const float cosines = dot(product(own.a[i], rotation_a), other.a[i]) +
                          dot(product(own.b[i], rotation_b), other.b[i]);
    const float noise = own.variance[i] + other.variance[i] + length2 * own.slope_variance[i];
    const float misfit = (4 - 2 * cosines) / noise * place.inverse_misfit;
    const float ramp = 1.5F - 1.5F * misfit;
    const float share = ramp < 0 ? 0.0F : (ramp > 1 ? 1.0F : ramp);
    const float w = place.weight * share;
    const float wx = w * place.x;
    const float wy = w * place.y;
    sums.a.add(i, rotated_back(measured.a[i], rotation_a), w, wx, wy);
    sums.b.add(i, rotated_back(measured.b[i], rotation_b), w, wx, wy);
    const float information = measured.information[i];
    sums.s[i] += w * information;
    sums.sx[i] += wx * information;
    sums.sy[i] += wy * information;
    sums.sxx[i] += wx * place.x * information;
    sums.sxy[i] += wx * place.y * information;
    sums.syy[i] += wy * place.y * information;
    sums.s2[i] += w * w * information;
  }
}

/// The sum phasor of one frequency over a window, and the score of the slope.
struct MeanPhasor {
  float length;
  Complex direction;    ///< unit
  float slope_score_x;  ///< derivative of the log likelihood by the slope along x
  float slope_score_y;  ///< derivative of the log likelihood by the slope along y

  MeanPhasor(const FrequencySums& sums, int i)
      : length(std::hypot(sums.re[i], sums.im[i])),
        direction{sums.re[i] / length, sums.im[i] / length},
        slope_score_x(rotated_back({sums.x_re[i], sums.x_im[i]}, direction).im),
        slope_score_y(rotated_back({sums.y_re[i], sums.y_im[i]}, direction).im) {}

  /// The direction, rotated by `angle`, radians.
  Complex rotated(float angle) const {
    return product(direction, {std::cos(angle), std::sin(angle)});
  }
};

/// Estimates the plane of one pixel by one step of Fisher scoring, starting at the plane of
/// `before`, by whose slopes the sums were rotated back (docs/filters.md, equations 11 and 12). The
/// phases of both frequencies are independent; the slope is common to both. Leaves the plane empty
/// if no pixel of the window contributes.
void solve(const SumRow& sums, int v, int i, const WindowGrowth& growth, const PhasePlanes& before,
           PhasePlanes& out) {
  const float s = sums.s[i];
  if (!(s > 0)) return;
  const MeanPhasor a(sums.a, i);
  const MeanPhasor b(sums.b, i);
  if (!(a.length > 0 && b.length > 0)) return;
  const auto ratio = static_cast<float>(growth.wavelength_ratio);
  const float both = 1 + ratio * ratio;
  const float prior = 1 / static_cast<float>(growth.slope_sigma * growth.slope_sigma);
  const float mean_x = sums.sx[i] / s;
  const float mean_y = sums.sy[i] / s;
  const float xx = both * (sums.sxx[i] - mean_x * sums.sx[i]) + prior;
  const float xy = both * (sums.sxy[i] - mean_x * sums.sy[i]);
  const float yy = both * (sums.syy[i] - mean_y * sums.sy[i]) + prior;
  const float determinant = xx * yy - xy * xy;
  const float slope_x = before.slope_x.row(v)[i];
  const float slope_y = before.slope_y.row(v)[i];
  const float score_x = a.slope_score_x + ratio * b.slope_score_x - prior * slope_x;
  const float score_y = a.slope_score_y + ratio * b.slope_score_y - prior * slope_y;
  const float step_x = (yy * score_x - xy * score_y) / determinant;
  const float step_y = (xx * score_y - xy * score_x) / determinant;
  // The sum phasor gives the phase at the centroid of the window; the plane needs that at the
  // pixel.
  const float back = -(mean_x * step_x + mean_y * step_y);
  const Complex at_a = a.rotated(back);
  const Complex at_b = b.rotated(ratio * back);
  const float spread = sums.s2[i] / s;
  const float lever = yy * mean_x * mean_x - 2 * xy * mean_x * mean_y + xx * mean_y * mean_y;
  out.a.re.row(v)[i] = at_a.re;
  out.a.im.row(v)[i] = at_a.im;
  out.b.re.row(v)[i] = at_b.re;
  out.b.im.row(v)[i] = at_b.im;
  out.slope_x.row(v)[i] = slope_x + step_x;
  out.slope_y.row(v)[i] = slope_y + step_y;
  out.variance.row(v)[i] = spread / s;
  out.lever_variance.row(v)[i] = spread * lever / determinant;
  out.slope_variance.row(v)[i] = 0.5F * spread * (xx + yy) / determinant;
  out.coherence.row(v)[i] = (a.length + b.length) / (2 * s);
}

/// Estimates the planes of all pixels from windows of one radius. Its buffers are used again in
/// each step.
class WindowStep {
 public:
  WindowStep(const Phasors& phasors, int rows, int cols, int margin, const WindowGrowth& growth)
      : phasors_(phasors),
        rows_(rows),
        cols_(cols),
        margin_(margin),
        growth_(growth),
        sums_(cols),
        right_(cols),
        down_(cols),
        row_start_(cols),
        rotors_(cols) {}

  /// The planes from windows of `radius_px`, given those of the previous step.
  PhasePlanes grow(const PhasePlanes& before, double radius_px, double inverse_misfit) {
    PhasePlanes out(rows_, cols_, margin_);
    for (int v = 0; v < rows_; ++v) {
      sums_.set_zero();
      add_window(before, v, static_cast<float>(radius_px), static_cast<float>(inverse_misfit));
      for (int i = 0; i < cols_; ++i) solve(sums_.row(), v, i, growth_, before, out);
    }
    return out;
  }

 private:
  /// Adds up the windows of all pixels of row v.
  void add_window(const PhasePlanes& before, int v, float radius_px, float inverse_misfit) {
    const int reach = static_cast<int>(std::ceil(radius_px)) - 1;
    const int top = std::max(-reach, -v);
    const int bottom = std::min(reach, rows_ - 1 - v);
    const auto set = [&](int x, int y, Rotors& rotors) {
      set_rotors(cols_, before.slope_x.row(v), before.slope_y.row(v), x, y,
                 static_cast<float>(growth_.wavelength_ratio), rotors);
    };
    set(1, 0, right_);
    set(0, 1, down_);
    set(-reach, top, row_start_);
    for (int y = top; y <= bottom; ++y) {
      rotors_ = row_start_;
      for (int x = -reach; x <= reach; ++x) {
        const float share = static_cast<float>(x * x + y * y) / (radius_px * radius_px);
        if (share < 1) {
          add_place(cols_,
                    {static_cast<float>(x), static_cast<float>(y), 1 - share, inverse_misfit},
                    RotorRow(rotors_.a), RotorRow(rotors_.b), PhasePlaneRow(before, v, 0),
                    PhasePlaneRow(before, v + y, x), MeasuredRow(phasors_, v + y, x), sums_.row());
        }
        rotate(cols_, rotors_, right_);
      }
      rotate(cols_, row_start_, down_);
    }
  }

  const Phasors& phasors_;
  int rows_;
  int cols_;
  int margin_;
  const WindowGrowth& growth_;
  WindowSums sums_;
  Rotors right_;
  Rotors down_;
  Rotors row_start_;
  Rotors rotors_;
};

}  // namespace

float phase_information(float sigma_cycles) {
  const PhasorMoments moments(sigma_cycles);
  return moments.mean * moments.mean / moments.variance_across;
}

Phasors::Phasors(int rows, int cols, int margin) : a(rows, cols, margin), b(a), information(a.re) {}

Phasors::Phasors(const ImageF& phase_a, const ImageF& phase_b, const ImageF& sigma_cycles,
                 int margin)
    : Phasors(static_cast<int>(phase_a.rows()), static_cast<int>(phase_a.cols()), margin) {
  for (int v = 0; v < phase_a.rows(); ++v) {
    for (int u = 0; u < phase_a.cols(); ++u) {
      const float phase_a_rad = two_pi * phase_a(v, u);
      const float phase_b_rad = two_pi * phase_b(v, u);
      if (!std::isfinite(phase_a_rad + phase_b_rad + sigma_cycles(v, u))) continue;
      const PhasorMoments moments(sigma_cycles(v, u));
      const float weight = moments.mean / moments.variance_across;
      a.re.row(v)[u] = weight * std::cos(phase_a_rad);
      a.im.row(v)[u] = weight * std::sin(phase_a_rad);
      b.re.row(v)[u] = weight * std::cos(phase_b_rad);
      b.im.row(v)[u] = weight * std::sin(phase_b_rad);
      information.row(v)[u] = weight * moments.mean;
    }
  }
}

PhasePlanes::PhasePlanes(int rows, int cols, int margin)
    : a(rows, cols, margin),
      b(a),
      slope_x(a.re),
      slope_y(a.re),
      variance(rows, cols, margin, 1e6F),  // phase unknown
      lever_variance(a.re),
      slope_variance(a.re),
      coherence(a.re) {}

PhasePlanes grow_phase_planes(const Phasors& phasors, int rows, int cols,
                              const WindowGrowth& growth) {
  const int margin = static_cast<int>(std::ceil(growth.last_radius_px));
  // The radius grows by the same ratio in each step and ends at the last radius.
  const double whole = growth.last_radius_px / growth.first_radius_px;
  const int steps =
      std::max(1, static_cast<int>(std::ceil(std::log(whole) / std::log(growth.growth))));
  WindowStep step(phasors, rows, cols, margin, growth);
  // In the first step there are no planes to compare: all pixels of the window are accepted.
  PhasePlanes planes = step.grow(PhasePlanes(rows, cols, margin),
                                 std::min(growth.first_radius_px, growth.last_radius_px), 0);
  for (int i = 1; i <= steps; ++i) {
    const double radius_px =
        growth.first_radius_px * std::pow(whole, static_cast<double>(i) / steps);
    planes = step.grow(planes, radius_px, 1 / growth.max_misfit);
  }
  return planes;
}

}  // namespace tofmap

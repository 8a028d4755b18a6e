// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "phasor_windows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <tofmap/core/modulation.hpp>
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

/// Unit phasors of the phase that the plane of each pixel of a row adds between the pixel and an
/// offset, for each frequency.
class Rotors {
 public:
  Rotors(std::size_t frequencies, int cols) : frequencies_(frequencies, RowPhasors(cols)) {}

  RotorRow row(std::size_t frequency) { return RotorRow(frequencies_[frequency]); }

  /// Sets the rotors to those of the offset (x, y).
  void set(int pixels, const float* slope_x, const float* slope_y, int x, int y,
           const std::vector<float>& wavelength_ratios) {
    for (std::size_t f = 0; f < frequencies_.size(); ++f) {
      const RotorRow out = row(f);
      for (int i = 0; i < pixels; ++i) {
        const float angle = slope_x[i] * static_cast<float>(x) + slope_y[i] * static_cast<float>(y);
        out.re[i] = std::cos(wavelength_ratios[f] * angle);
        out.im[i] = std::sin(wavelength_ratios[f] * angle);
      }
    }
  }

  void rotate_by(int pixels, Rotors& by) {
    for (std::size_t f = 0; f < frequencies_.size(); ++f) rotate(pixels, row(f), by.row(f));
  }

 private:
  std::vector<RowPhasors> frequencies_;
};

/// Weighted sums of the phasors z of one frequency over the windows of a row's pixels: of z, x z
/// and y z, where (x, y) is the offset.
struct PhasorSums {
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

/// Sums of the information over the windows of a row's pixels.
struct InformationSums {
  float *s, *sx, *sy, *sxx, *sxy, *syy;  ///< weighted information, times products of the offset
  float* s2;                             ///< information times squared weights
};

/// Memory of the sums of a row.
class WindowSums {
 public:
  WindowSums(std::size_t frequencies, int cols)
      : values_(information_sums + phasor_sums * frequencies,
                std::vector<float>(static_cast<std::size_t>(cols))) {}

  void set_zero() {
    for (auto& values : values_) std::ranges::fill(values, 0.0F);
  }

  InformationSums information() { return {at(0), at(1), at(2), at(3), at(4), at(5), at(6)}; }

  PhasorSums phasors(std::size_t frequency) {
    const std::size_t first = information_sums + phasor_sums * frequency;
    return {at(first), at(first + 1), at(first + 2), at(first + 3), at(first + 4), at(first + 5)};
  }

 private:
  static constexpr std::size_t information_sums = 7;
  static constexpr std::size_t phasor_sums = 6;

  float* at(std::size_t i) { return values_[i].data(); }

  std::vector<std::vector<float>> values_;
};

/// One offset in the window.
struct Place {
  float x;
  float y;
  float weight;
  float inverse_misfit;  ///< 1 / the largest accepted misfit; 0 accepts all pixels
};

/// How uncertain the planes of a row are, from column `offset` on.
struct UncertaintyRow {
  const float* variance;
  const float* slope_variance;

  UncertaintyRow(const PhasePlanes& planes, int v, int offset)
      : variance(planes.variance.row(v) + offset),
        slope_variance(planes.slope_variance.row(v) + offset) {}
};

/// Phasors of one frequency at a place: of the plane of the window's pixel, of that of the pixel at
/// the place, and the rotors between the two.
struct PlacePhasors {
  PhasorRow own;
  PhasorRow other;
  RotorRow rotors;
};

/// Adds to `misfit` by how much the phases of one frequency differ between the plane of the pixel
/// at a place and that of the window's pixel, squared standard deviations (docs/filters.md,
/// equation 13).
TOFMAP_VECTOR_CLONES void add_misfit(int pixels, const Place& place, float wavelength_ratio,
                                     const PlacePhasors& phasors_, const UncertaintyRow& own_,
                                     const UncertaintyRow& other_, float* misfit) {
  const PlacePhasors phasors = phasors_;
  const UncertaintyRow own = own_;
  const UncertaintyRow other = other_;
  const float length =
      wavelength_ratio * wavelength_ratio * (place.x * place.x + place.y * place.y);
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float cosine = dot(product(phasors.own[i], phasors.rotors[i]), phasors.other[i]);
    const float variance = own.variance[i] + other.variance[i] + length * own.slope_variance[i];
    misfit[i] += (2 - 2 * cosine) / variance;
  }
}

/// Replaces misfits by the weights of the pixels at one offset: full up to a third of the largest
/// accepted misfit, falling linearly to 0 at the largest. Adds their information to the windows.
TOFMAP_VECTOR_CLONES void weigh_place(int pixels, const Place& place_, const float* information,
                                      float* misfits_or_weights, const InformationSums& sums_) {
  const Place place = place_;
  const InformationSums sums = sums_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float ramp = 1.5F - 1.5F * misfits_or_weights[i] * place.inverse_misfit;
    const float share = ramp < 0 ? 0.0F : (ramp > 1 ? 1.0F : ramp);
    const float w = place.weight * share;
    const float weighted = w * information[i];
    misfits_or_weights[i] = w;
    sums.s[i] += weighted;
    sums.sx[i] += place.x * weighted;
    sums.sy[i] += place.y * weighted;
    sums.sxx[i] += place.x * place.x * weighted;
    sums.sxy[i] += place.x * place.y * weighted;
    sums.syy[i] += place.y * place.y * weighted;
    sums.s2[i] += w * weighted;
  }
}

/// Adds the phasors of one frequency at one offset to the windows.
TOFMAP_VECTOR_CLONES void add_phasors(int pixels, const Place& place_, const float* weights,
                                      const PhasorRow& measured_, const RotorRow& rotors_,
                                      const PhasorSums& sums_) {
  const Place place = place_;
  const PhasorRow measured = measured_;
  const RotorRow rotors = rotors_;
  const PhasorSums sums = sums_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float w = weights[i];
    sums.add(i, rotated_back(measured[i], rotors[i]), w, w * place.x, w * place.y);
  }
}

/// The sum phasor of one frequency over a window, and the score of the slope.
struct MeanPhasor {
  float length;
  Complex direction;    ///< unit
  float slope_score_x;  ///< derivative of the log likelihood by the slope along x
  float slope_score_y;  ///< derivative of the log likelihood by the slope along y

  MeanPhasor(const PhasorSums& sums, int i)
      : length(std::hypot(sums.re[i], sums.im[i])),
        direction{sums.re[i] / length, sums.im[i] / length},
        slope_score_x(rotated_back({sums.x_re[i], sums.x_im[i]}, direction).im),
        slope_score_y(rotated_back({sums.y_re[i], sums.y_im[i]}, direction).im) {}
};

/// Estimates the plane of one pixel by one step of Fisher scoring, starting at the plane of
/// `before`, by whose slopes the sums were rotated back (docs/filters.md, equations 11 and 12). The
/// phases of the frequencies are independent; the slope is common to all. Leaves the plane empty if
/// no pixel of the window contributes.
void solve(WindowSums& window, int v, int i, const WindowGrowth& growth, const PhasePlanes& before,
           PhasePlanes& out) {
  const InformationSums sums = window.information();
  const float s = sums.s[i];
  if (!(s > 0)) return;
  const float prior = 1 / static_cast<float>(growth.slope_sigma * growth.slope_sigma);
  const float slope_x = before.slope_x.row(v)[i];
  const float slope_y = before.slope_y.row(v)[i];
  const std::size_t frequencies = out.phases.size();
  float all = 0;  // sum of the squared wavelength ratios
  float length = 0;
  float score_x = -prior * slope_x;
  float score_y = -prior * slope_y;
  std::array<Complex, most_frequencies> directions;
  for (std::size_t f = 0; f < frequencies; ++f) {
    const MeanPhasor mean(window.phasors(f), i);
    if (!(mean.length > 0)) return;
    const float ratio = growth.wavelength_ratios[f];
    directions[f] = mean.direction;
    all += ratio * ratio;
    length += mean.length;
    score_x += ratio * mean.slope_score_x;
    score_y += ratio * mean.slope_score_y;
  }
  const float mean_x = sums.sx[i] / s;
  const float mean_y = sums.sy[i] / s;
  const float xx = all * (sums.sxx[i] - mean_x * sums.sx[i]) + prior;
  const float xy = all * (sums.sxy[i] - mean_x * sums.sy[i]);
  const float yy = all * (sums.syy[i] - mean_y * sums.sy[i]) + prior;
  const float determinant = xx * yy - xy * xy;
  const float step_x = (yy * score_x - xy * score_y) / determinant;
  const float step_y = (xx * score_y - xy * score_x) / determinant;
  // The sum phasor gives the phase at the centroid of the window; the plane needs that at the
  // pixel.
  const float back = -(mean_x * step_x + mean_y * step_y);
  for (std::size_t f = 0; f < frequencies; ++f) {
    const float angle = growth.wavelength_ratios[f] * back;
    const Complex at_pixel = product(directions[f], {std::cos(angle), std::sin(angle)});
    out.phases[f].re.row(v)[i] = at_pixel.re;
    out.phases[f].im.row(v)[i] = at_pixel.im;
  }
  const float spread = sums.s2[i] / s;
  const float lever = yy * mean_x * mean_x - 2 * xy * mean_x * mean_y + xx * mean_y * mean_y;
  out.slope_x.row(v)[i] = slope_x + step_x;
  out.slope_y.row(v)[i] = slope_y + step_y;
  out.variance.row(v)[i] = spread / s;
  out.lever_variance.row(v)[i] = spread * lever / determinant;
  out.slope_variance.row(v)[i] = 0.5F * spread * (xx + yy) / determinant;
  out.coherence.row(v)[i] = length / (static_cast<float>(frequencies) * s);
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
        sums_(frequencies(), cols),
        weights_(static_cast<std::size_t>(cols)),
        right_(frequencies(), cols),
        down_(right_),
        row_start_(right_),
        rotors_(right_) {}

  /// The planes from windows of `radius_px`, given those of the previous step.
  PhasePlanes grow(const PhasePlanes& before, double radius_px, double inverse_misfit) {
    PhasePlanes out(frequencies(), rows_, cols_, margin_);
    for (int v = 0; v < rows_; ++v) {
      sums_.set_zero();
      add_window(before, v, static_cast<float>(radius_px), static_cast<float>(inverse_misfit));
      for (int i = 0; i < cols_; ++i) solve(sums_, v, i, growth_, before, out);
    }
    return out;
  }

 private:
  std::size_t frequencies() const { return phasors_.frequencies.size(); }

  /// Adds up the windows of all pixels of row v.
  void add_window(const PhasePlanes& before, int v, float radius_px, float inverse_misfit) {
    const int reach = static_cast<int>(std::ceil(radius_px)) - 1;
    const int top = std::max(-reach, -v);
    const int bottom = std::min(reach, rows_ - 1 - v);
    const auto set = [&](int x, int y, Rotors& rotors) {
      rotors.set(cols_, before.slope_x.row(v), before.slope_y.row(v), x, y,
                 growth_.wavelength_ratios);
    };
    set(1, 0, right_);
    set(0, 1, down_);
    set(-reach, top, row_start_);
    for (int y = top; y <= bottom; ++y) {
      rotors_ = row_start_;
      for (int x = -reach; x <= reach; ++x) {
        const float share = static_cast<float>(x * x + y * y) / (radius_px * radius_px);
        if (share < 1) {
          add_place(before, v,
                    {static_cast<float>(x), static_cast<float>(y), 1 - share, inverse_misfit});
        }
        rotors_.rotate_by(cols_, right_);
      }
      row_start_.rotate_by(cols_, down_);
    }
  }

  /// Adds the pixels at one offset from those of row v, weighted by how well their planes agree
  /// with the plane of the window's pixel.
  void add_place(const PhasePlanes& before, int v, const Place& place) {
    const int x = static_cast<int>(place.x);
    const int other_v = v + static_cast<int>(place.y);
    const UncertaintyRow own(before, v, 0);
    const UncertaintyRow other(before, other_v, x);
    std::ranges::fill(weights_, 0.0F);
    for (std::size_t f = 0; f < frequencies(); ++f) {
      const PhasorImage& phases = before.phases[f];
      add_misfit(cols_, place, growth_.wavelength_ratios[f],
                 {PhasorRow(phases, v, 0), PhasorRow(phases, other_v, x), rotors_.row(f)}, own,
                 other, weights_.data());
    }
    weigh_place(cols_, place, phasors_.information.row(other_v) + x, weights_.data(),
                sums_.information());
    for (std::size_t f = 0; f < frequencies(); ++f) {
      add_phasors(cols_, place, weights_.data(), PhasorRow(phasors_.frequencies[f], other_v, x),
                  rotors_.row(f), sums_.phasors(f));
    }
  }

  const Phasors& phasors_;
  int rows_;
  int cols_;
  int margin_;
  const WindowGrowth& growth_;
  WindowSums sums_;
  std::vector<float> weights_;  ///< of the pixels at one offset
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

Phasors::Phasors(const std::vector<ImageF>& phases, const ImageF& sigma_cycles, int margin)
    : information(static_cast<int>(sigma_cycles.rows()), static_cast<int>(sigma_cycles.cols()),
                  margin) {
  const auto rows = static_cast<int>(sigma_cycles.rows());
  const auto cols = static_cast<int>(sigma_cycles.cols());
  frequencies.assign(phases.size(), PhasorImage(rows, cols, margin));
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      float sum = sigma_cycles(v, u);
      for (const ImageF& phase : phases) sum += phase(v, u);
      if (!std::isfinite(sum)) continue;
      const PhasorMoments moments(sigma_cycles(v, u));
      const float weight = moments.mean / moments.variance_across;
      for (std::size_t f = 0; f < phases.size(); ++f) {
        const float phase_rad = two_pi * phases[f](v, u);
        frequencies[f].re.row(v)[u] = weight * std::cos(phase_rad);
        frequencies[f].im.row(v)[u] = weight * std::sin(phase_rad);
      }
      information.row(v)[u] = weight * moments.mean;
    }
  }
}

PhasePlanes::PhasePlanes(std::size_t frequencies, int rows, int cols, int margin)
    : phases(frequencies, PhasorImage(rows, cols, margin)),
      slope_x(rows, cols, margin),
      slope_y(slope_x),
      variance(rows, cols, margin, 1e6F),  // phase unknown
      lever_variance(slope_x),
      slope_variance(slope_x),
      coherence(slope_x) {}

PhasePlanes grow_phase_planes(const Phasors& phasors, int rows, int cols,
                              const WindowGrowth& growth) {
  const int margin = static_cast<int>(std::ceil(growth.last_radius_px));
  // The radius grows by the same ratio in each step and ends at the last radius.
  const double whole = growth.last_radius_px / growth.first_radius_px;
  const int steps =
      std::max(1, static_cast<int>(std::ceil(std::log(whole) / std::log(growth.growth))));
  WindowStep step(phasors, rows, cols, margin, growth);
  // In the first step there are no planes to compare: all pixels of the window are accepted.
  const std::size_t frequencies = phasors.frequencies.size();
  PhasePlanes planes = step.grow(PhasePlanes(frequencies, rows, cols, margin),
                                 std::min(growth.first_radius_px, growth.last_radius_px), 0);
  for (int i = 1; i <= steps; ++i) {
    const double radius_px =
        growth.first_radius_px * std::pow(whole, static_cast<double>(i) / steps);
    planes =
        step.grow(planes, radius_px, 1 / (static_cast<double>(frequencies) * growth.max_misfit));
  }
  return planes;
}

}  // namespace tofmap

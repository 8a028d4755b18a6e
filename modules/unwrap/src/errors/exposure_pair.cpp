// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/exposure_pair.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Number of pixels that find_nearest() processes at a time.
constexpr int block = 256;

TOFMAP_VECTOR_CLONES void warp_all(const ExposureWarp& warp_, int count, const float* ray_x,
                                   const float* ray_y, const float* ray_z, const float* range_m,
                                   float* col, float* row, float* shrinkage_m) {
  const auto [r0, r1, r2, r3, r4, r5, r6, r7, r8] = warp_.b_from_a;
  const auto [tx, ty, tz] = warp_.translation_m;
  const auto [fx, fy, cx, cy] = warp_.pinhole;
  const auto [k1, k2, p1, p2, k3] = warp_.distortion;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float px = range_m[i] * ray_x[i] - tx;
    const float py = range_m[i] * ray_y[i] - ty;
    const float pz = range_m[i] * ray_z[i] - tz;
    const float qx = r0 * px + r1 * py + r2 * pz;
    const float qy = r3 * px + r4 * py + r5 * pz;
    const float qz = r6 * px + r7 * py + r8 * pz;
    const float x = qx / qz;
    const float y = qy / qz;
    const float square = x * x + y * y;
    const float radial = 1 + square * (k1 + square * (k2 + square * k3));
    const float dx = x * radial + 2 * p1 * x * y + p2 * (square + 2 * x * x);
    const float dy = y * radial + p1 * (square + 2 * y * y) + 2 * p2 * x * y;
    const float behind = qz > 0 ? 0.0F : nan;
    col[i] = fx * dx + cx + behind;
    row[i] = fy * dy + cy + behind;
    shrinkage_m[i] = range_m[i] - std::sqrt(px * px + py * py + pz * pz);
  }
}

/// log10 with an error of at most 2e-3: a cubic polynomial in the mantissa.
[[gnu::always_inline]] inline float quick_log10(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  const auto exponent = static_cast<float>((bits >> 23) - 127);
  const float mantissa = std::bit_cast<float>((bits & 0x007fffff) | 0x3f800000) - 1;
  const float log2 = exponent + mantissa * (1.4187F + mantissa * (-0.5810F + mantissa * 0.1623F));
  return 0.30103F * log2;
}

/// The coefficients of the harmonics of one frequency, metres.
struct Harmonics {
  std::array<float, CameraErrors::harmonics> cosine_m;
  std::array<float, CameraErrors::harmonics> sine_m;

  /// `first` is the index of the first coefficient in CameraErrors: 1 for A and 3 for B.
  Harmonics(const CameraErrors& errors, std::size_t first) {
    for (std::size_t k = 0; k < cosine_m.size(); ++k) {
      cosine_m[k] = static_cast<float>(errors.coefficient_m[4 * k + first]);
      sine_m[k] = static_cast<float>(errors.coefficient_m[4 * k + first + 1]);
    }
  }
};

TOFMAP_VECTOR_CLONES void add_harmonics(int count, const Harmonics& harmonics_, const float* phase,
                                        float* mean_m) {
  const Harmonics harmonics = harmonics_;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    // x is half the phase angle, 0 … π, minus π/2. Its sine and cosine by Taylor series have errors
    // of at most 4e-6 and 3e-5.
    const float positive = phase[i] >= 0 ? phase[i] : 0.0F;
    const float x = std::numbers::pi_v<float> * ((positive < 1 ? positive : 0.0F) - 0.5F);
    const float q = x * x;
    const float sine =
        x * (1 + q * (-1 / 6.0F + q * (1 / 120.0F + q * (-1 / 5040.0F + q / 362880))));
    const float cosine = 1 + q * (-0.5F + q * (1 / 24.0F + q * (-1 / 720.0F + q / 40320)));
    // The whole angle is 2x + π, so both its cosine and its sine are those of 2x with opposite
    // sign.
    const float c1 = 2 * sine * sine - 1;
    const float s1 = -2 * sine * cosine;
    float c_before = 1;
    float s_before = 0;
    float c = c1;
    float s = s1;
    float sum = 0;
#pragma GCC unroll 8
    for (std::size_t k = 0; k < harmonics.cosine_m.size(); ++k) {
      sum += harmonics.cosine_m[k] * c + harmonics.sine_m[k] * s;
      const float c_next = 2 * c1 * c - c_before;
      const float s_next = 2 * c1 * s - s_before;
      c_before = c;
      s_before = s;
      c = c_next;
      s = s_next;
    }
    mean_m[i] += sum;
  }
}

TOFMAP_VECTOR_CLONES void add_by_amplitude(int count, float per_decade_m, float reference,
                                           const float* amplitude, float* mean_m) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float relative = amplitude[i] / reference;
    const float within = relative > 1e-4F ? relative : 1e-4F;
    mean_m[i] += per_decade_m * quick_log10(within < 1e4F ? within : 1e4F);
  }
}

/// One wrap count.
struct Step {
  float shift_cycles;     ///< change of the residual compared to wrap count 0
  float farthest_cycles;  ///< largest phase at which this wrap count is within the limits
  float count;
};

TOFMAP_VECTOR_CLONES void take_nearer(int count, const float* phase_a, const float* rest_cycles,
                                      const Step& step_, float* least, float* best) {
  const Step step = step_;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float shifted = to_half_cycle(rest_cycles[i] + step.shift_cycles);
    const float size = shifted < 0 ? -shifted : shifted;
    const float before = least[i] < 0 ? -least[i] : least[i];
    const bool is_nearer = size < before && phase_a[i] <= step.farthest_cycles;
    replace_if(is_nearer, shifted, least[i]);
    replace_if(is_nearer, step.count, best[i]);
  }
}

TOFMAP_VECTOR_CLONES void subtract_prediction(int count, const float* phase_a, const float* phase_b,
                                              const float* predicted_m, float ratio,
                                              float per_wavelength, float* rest_cycles) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float rest = phase_a[i] * ratio - phase_b[i] - predicted_m[i] * per_wavelength;
    rest_cycles[i] = rest == rest ? rest : 0.0F;
  }
}

}  // namespace

Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_rad / angle).toRotationMatrix();
}

ExposureWarp::ExposureWarp(const CameraModel& camera, const ExposureMotion& motion)
    : pinhole{static_cast<float>(camera.fx_px), static_cast<float>(camera.fy_px),
              static_cast<float>(camera.cx_px), static_cast<float>(camera.cy_px)} {
  const Eigen::Matrix3d a_from_b = rotation_matrix(motion.rotation_rad);
  for (std::size_t i = 0; i < 9; ++i) {
    b_from_a[i] = static_cast<float>(
        a_from_b(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(i / 3)));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    translation_m[i] = static_cast<float>(motion.translation_m[static_cast<Eigen::Index>(i)]);
  }
  for (std::size_t i = 0; i < 5; ++i) distortion[i] = static_cast<float>(camera.distortion[i]);
}

void warp(const ExposureWarp& warp, int count, const float* ray_x, const float* ray_y,
          const float* ray_z, const float* range_m, float* col, float* row, float* shrinkage_m) {
  warp_all(warp, count, ray_x, ray_y, ray_z, range_m, col, row, shrinkage_m);
}

void predict_errors_of_a(const CameraErrors& errors, int count, const float* phase_a,
                         const float* amplitude_a, float* mean_m) {
  std::fill_n(mean_m, count, static_cast<float>(errors.offset_m()));
  add_harmonics(count, Harmonics(errors, 1), phase_a, mean_m);
  if (amplitude_a == nullptr || errors.per_decade_m() == 0) return;
  add_by_amplitude(count, static_cast<float>(errors.per_decade_m()),
                   static_cast<float>(errors.reference_amplitude), amplitude_a, mean_m);
}

void add_errors_of_b(const CameraErrors& errors, int count, const float* phase_b, float* mean_m) {
  add_harmonics(count, Harmonics(errors, 3), phase_b, mean_m);
}

void predict_camera_errors(const CameraErrors& errors, int count, const float* phase_a,
                           const float* phase_b, const float* amplitude_a, float* mean_m) {
  predict_errors_of_a(errors, count, phase_a, amplitude_a, mean_m);
  add_errors_of_b(errors, count, phase_b, mean_m);
}

void find_nearest(const PairLimits& limits, int count, const float* phase_a, const float* phase_b,
                  const float* predicted_m, float* error_m, float* range_m) {
  const double ratio = limits.wavelength_a_m / limits.wavelength_b_m;
  const auto wavelength_a_m = static_cast<float>(limits.wavelength_a_m);
  const auto wavelength_b_m = static_cast<float>(limits.wavelength_b_m);
  std::array<float, block> rest;
  std::array<float, block> least;
  std::array<float, block> best;
  for (int done = 0; done < count; done += block) {
    const int pixels = std::min(block, count - done);
    subtract_prediction(pixels, phase_a + done, phase_b + done, predicted_m + done,
                        static_cast<float>(ratio), 1 / wavelength_b_m, rest.data());
    least.fill(1);
    best.fill(0);
    for (int n = 0; n < limits.count_a; ++n) {
      const Step step{static_cast<float>(residual_shift_cycles(ratio, n)),
                      farthest_phase_cycles(limits, n), static_cast<float>(n)};
      take_nearer(pixels, phase_a + done, rest.data(), step, least.data(), best.data());
    }
    for (int i = 0; i < pixels; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const float absent = 0 * phase_a[done + i] + 0 * phase_b[done + i];
      error_m[done + i] = least[at] * wavelength_b_m + absent;
      range_m[done + i] = (phase_a[done + i] + best[at]) * wavelength_a_m;
    }
  }
}

}  // namespace tofmap

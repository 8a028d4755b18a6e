// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/phase_smoothing.hpp"

#include "common/fast_math.hpp"
#include "common/phasor_math.hpp"

#include <array>
#include <cmath>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap::peers {
namespace {

/// The phasors of one frequency. Pixels without a return are zero.
struct Phasors {
  ImageF real;
  ImageF imaginary;
  ImageF amplitude;
  ImageF inverse;  ///< 1 / amplitude, 0 where the amplitude is 0
};

TOFMAP_VECTOR_CLONES void to_phasors(Eigen::Index count, const float* phase, const float* amplitude,
                                     Phasors& out) {
  float* real = out.real.data();
  float* imaginary = out.imaginary.data();
  float* length = out.amplitude.data();
  float* inverse = out.inverse.data();
#pragma GCC ivdep
  for (Eigen::Index i = 0; i < count; ++i) {
    const float given = amplitude[i];
    const float given_angle = phase[i];
    const bool valid = given > 0;  // not if NaN
    const float a = valid ? given : 0.0F;
    const float angle = valid ? given_angle : 0.0F;
    real[i] = a * cos_of_cycles(angle);
    imaginary[i] = a * sin_of_cycles(angle);
    length[i] = a;
    inverse[i] = valid ? 1 / given : 0.0F;
  }
}

struct Kernel {
  float steepness;
  float min_amplitude;
  std::array<float, 3> spatial;  ///< by |du| + |dv|
};

/// A row of the result.
struct Target {
  float* phase;
  float* amplitude;
  float* differences;  ///< sums of d
};

/// The phasors of a row.
struct RowOfPhasors {
  const float* real;
  const float* imaginary;
  const float* amplitude;
  const float* inverse;
};

RowOfPhasors row_of(const Phasors& phasors, Eigen::Index v) {
  return {&phasors.real(v, 0), &phasors.imaginary(v, 0), &phasors.amplitude(v, 0),
          &phasors.inverse(v, 0)};
}

/// What a pixel compares its neighbours with.
struct Centre {
  float cosine;
  float sine;
  float least_amplitude;
  float steepness;
};

struct Sums {
  float real;
  float imaginary;
  float weight;
  float difference;
};

[[gnu::always_inline]] inline void add_neighbour(const Centre& centre, float spatial,
                                                 const RowOfPhasors& row, Eigen::Index n,
                                                 Sums& sums) {
  const float real = row.real[n];
  const float imaginary = row.imaginary[n];
  const float amplitude = row.amplitude[n];
  const float alike = (centre.cosine * real + centre.sine * imaginary) * row.inverse[n];
  const float difference = 0.5F * (1 - alike);
  const float counts = amplitude >= centre.least_amplitude ? 1.0F : 0.0F;
  const float weight = counts * spatial * exp_of_negative(-centre.steepness * difference);
  sums.real += weight * real;
  sums.imaginary += weight * imaginary;
  sums.weight += weight;
  sums.difference += counts * difference;
}

/// Filters the row `here` between `above` and `below`. Pixels without a return get NaN.
TOFMAP_VECTOR_CLONES void smooth_row(Eigen::Index cols, const Kernel& kernel,
                                     const RowOfPhasors& above, const RowOfPhasors& here,
                                     const RowOfPhasors& below, const Target& out) {
  const auto [own, beside, diagonal] = kernel.spatial;
  const float min_amplitude = kernel.min_amplitude;
  const float steepness = kernel.steepness;
  float* phase = out.phase;
  float* amplitude = out.amplitude;
  float* differences = out.differences;
#pragma GCC ivdep
  for (Eigen::Index u = 1; u < cols - 1; ++u) {
    const bool strong = here.amplitude[u] >= min_amplitude;
    const float inverse = here.inverse[u];
    // Amplitudes of pixels without a return are 0.
    const Centre centre{.cosine = here.real[u] * inverse,
                        .sine = here.imaginary[u] * inverse,
                        .least_amplitude = strong ? min_amplitude : 1e-12F,
                        .steepness = strong ? steepness : 0.0F};
    Sums sums{own * here.real[u], own * here.imaginary[u], own, 0};
    add_neighbour(centre, diagonal, above, u - 1, sums);
    add_neighbour(centre, beside, above, u, sums);
    add_neighbour(centre, diagonal, above, u + 1, sums);
    add_neighbour(centre, beside, here, u - 1, sums);
    add_neighbour(centre, beside, here, u + 1, sums);
    add_neighbour(centre, diagonal, below, u - 1, sums);
    add_neighbour(centre, beside, below, u, sums);
    add_neighbour(centre, diagonal, below, u + 1, sums);
    const float length =
        std::sqrt(sums.real * sums.real + sums.imaginary * sums.imaginary) / sums.weight;
    const float without_return = here.amplitude[u] > 0 ? 0.0F : nan;
    phase[u] = angle_in_cycles(sums.real, sums.imaginary) + without_return;
    amplitude[u] = length + without_return;
    differences[u] = sums.difference + without_return;
  }
}

}  // namespace

SmoothedPhases smooth_phases(const ThreePhases& phases, const SmoothingOptions& options) {
  SmoothedPhases out{phases, ImageU8::Zero(phases.rows(), phases.cols())};
  Kernel kernel{.steepness = static_cast<float>(options.steepness),
                .min_amplitude = static_cast<float>(options.min_amplitude),
                .spatial = {}};
  for (std::size_t squared_px = 0; squared_px < 3; ++squared_px)
    kernel.spatial[squared_px] =
        static_cast<float>(std::exp(-0.5 * static_cast<double>(squared_px) /
                                    (options.spatial_sigma_px * options.spatial_sigma_px)));
  Phasors phasors;
  for (ImageF* image : {&phasors.real, &phasors.imaginary, &phasors.amplitude, &phasors.inverse})
    image->resize(phases.rows(), phases.cols());
  for (std::size_t m = 0; m < 3; ++m) {
    to_phasors(phases.phase_cycles[m].size(), phases.phase_cycles[m].data(),
               phases.amplitude[m].data(), phasors);
    ImageF differences = ImageF::Zero(phases.rows(), phases.cols());
    for (Eigen::Index v = 1; v < phases.rows() - 1; ++v)
      smooth_row(
          phases.cols(), kernel, row_of(phasors, v - 1), row_of(phasors, v), row_of(phasors, v + 1),
          {&out.phases.phase_cycles[m](v, 0), &out.phases.amplitude[m](v, 0), &differences(v, 0)});
    out.on_edge = (differences >= static_cast<float>(options.edge_limit))
                      .select(ImageU8::Ones(phases.rows(), phases.cols()), out.on_edge);
  }
  return out;
}

}  // namespace tofmap::peers

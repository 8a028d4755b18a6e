// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>

namespace tofmap {

/// The assumptions about scenes of the method `joint`. Symbols and equation numbers are those of
/// docs/unwrapping.md.
struct WrapCountPrior {
  /// ε of equation 11: probability that a pixel's residual comes from no surface; above 0 and below
  /// 1. A larger value gives the residual of a single pixel less weight.
  double outlier_share = UnwrapOptions{}.outlier_share;
  /// s of equation 12: typical difference between the true ranges of neighbouring pixels on one
  /// surface, metres, above 0.
  double slope_m = UnwrapOptions{}.slope_m;
  /// e_0 of equation 13: probability that two neighbours of equal amplitude are on different
  /// surfaces; above 0 and below 1.
  double edge_share = 0.02;
  /// R of equation 14, metres, above 0: from one surface to another, the range changes by any
  /// amount within ± R, all equally probable.
  double edge_reach_m = 25;
  /// Whether an edge between surfaces is more probable where the amplitude changes.
  bool amplitude_edges = UnwrapOptions{}.amplitude_edges;
  /// Whether the unary factors of mixed pixels are made nearly uniform, so that their neighbours
  /// decide their wrap counts. Needs amplitudes.
  bool mixed_pixels = UnwrapOptions{}.mixed_pixels;
};

/// Exponent of the likelihoods in unary factors.
inline constexpr float evidence_exponent = 4;

/// Smallest unary factor, also that of ranges beyond the limits.
inline constexpr float least_unary_factor = 1e-8F;

/// ε of mixed pixels: their residual is that of neither surface, so it tells next to nothing.
inline constexpr float mixed_outlier_share = 0.999F;

/// What was measured in pixels, in any order. All arrays have the same size. Loops run over whole
/// vectors of DiagonalLayout::lanes pixels, so the last pixels may be padding.
struct PixelArrays {
  std::vector<std::vector<float>> phases;        ///< of each frequency, cycles
  std::vector<std::vector<float>> variances_m2;  ///< of each frequency: noise and systematic errors
  std::vector<float> amplitude;                  ///< of the first frequency; 1 if it is not known
  std::vector<float> outlier_share;              ///< ε of equation 11

  /// Gives all arrays this size. Pixels are then without a return and of unknown amplitude.
  void assign(std::size_t pixels, std::size_t frequencies, float outlier);
};

/// The unary factors of equation 11 for cameras with at least two frequencies.
class UnaryFactors {
 public:
  explicit UnaryFactors(const UnwrapLimits& limits);

  /// Fills the factors of `count` pixels, a multiple of DiagonalLayout::lanes, which begin at
  /// `at`. They are bfloat16 numbers, one plane for each wrap count; planes are `step` apart.
  void fill(const PixelArrays& pixels, std::size_t at, int count, std::uint16_t* factors,
            std::size_t step) const;

 private:
  UnwrapLimits limits_;
  std::vector<std::size_t> others_;  ///< all frequencies but the first, by wavelength
  float farthest_cycles_;
};

/// The constants of equations 12 to 14.
struct EdgeScale {
  float wavelength_m;
  float slope_m2;
  float edge_share;
  float edge_density;  ///< density of the range difference between surfaces, 1 / m
  float amplitude_weight;

  EdgeScale(const UnwrapLimits& limits, const WrapCountPrior& prior);
};

/// Pixels that begin at `at`.
struct PixelsAt {
  const PixelArrays& pixels;
  std::size_t at;
};

/// Equations 12 to 14: the pairwise factors of `count` pixels, a multiple of DiagonalLayout::lanes,
/// and one neighbour of each, as in WrapCountModel::Edges.
void fill_pairwise_factors(const PixelsAt& from, const PixelsAt& to, int count,
                           const EdgeScale& scale, float* same, float* next);

/// Finds mixed pixels, whose amplitude lies well between those of two opposite neighbours: 1 where
/// a pixel is mixed, else 0. Pixels at the border of the image are never taken for mixed.
ImageU8 mixed_pixels(const ImageF& amplitude, const ImageF& sigma_cycles);

}  // namespace tofmap

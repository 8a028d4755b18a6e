// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap {

/// What a simulated pixel measured at A, apart from its wraps. The numbers are those of
/// `label_truth/NNNNNN.png`.
enum class PixelLabel : std::uint8_t {
  no_return = 0,
  right = 1,   ///< one surface, within noisy_range_m
  noisy = 2,   ///< one surface, but noise moved the range by more than that
  mixed = 3,   ///< several surfaces, and the range is one of theirs
  flying = 4,  ///< several surfaces, and a range where there is none
};

/// The range error from which on a pixel that sees one surface is noisy.
inline constexpr double noisy_range_m = 0.1;

/// One of the rays that a pixel is the mean of.
struct SubRay {
  Eigen::Vector3d direction;  ///< unit
  std::optional<RayHit> hit;
};

/// What a pixel saw whose rays form a grid of n x n, row by row, and which measured this phase of
/// the wavelength. Neighbouring rays see two surfaces if neither lies on the plane of the other's:
/// by more than 5 cm, and more than slanted surfaces differ from one ray to the next. A range is
/// that of a surface if it is no farther from it than 5 cm or three standard deviations of the
/// noise
/// (`sigma_m`).
PixelLabel label_pixel(std::span<const SubRay> rays, float phase_cycles, double wavelength_m,
                       double sigma_m);

}  // namespace tofmap

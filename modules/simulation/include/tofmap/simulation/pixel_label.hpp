// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap {

/// What a simulated pixel measured at A, regardless of its wrap count. The numbers are those in
/// `label_truth/NNNNNN.png`. What moves is a surface like any other.
enum class PixelLabel : std::uint8_t {
  no_return = 0,
  right = 1,   ///< the pixel sees one surface, and the range error is at most noisy_range_m
  noisy = 2,   ///< the pixel sees one surface, and the range error is larger than that
  mixed = 3,   ///< the pixel sees several surfaces, and has the range of one of them
  flying = 4,  ///< the pixel sees several surfaces, and has the range of none of them
};

/// Largest range error of a pixel that counts as right, metres.
inline constexpr double noisy_range_m = 0.1;

/// One of the rays over which the signal of a pixel is averaged.
struct SubRay {
  Eigen::Vector3d direction;  ///< unit vector
  std::optional<RayHit> hit;  ///< empty if the ray meets no surface
};

/// The label of a pixel that measured `phase_cycles` at `wavelength_m`. `rays` are its n x n rays,
/// row by row; `sigma_m` is the standard deviation of its range noise.
///
/// Two neighbouring rays see two surfaces if each hit lies off the plane of the other hit by more
/// than 5 cm plus the difference in range that the slant of both surfaces explains. The pixel of
/// several surfaces has the range of one of them if it is within 5 cm or three standard deviations
/// of it, whichever is larger. Ranges are compared modulo the wavelength. A NaN phase is no_return.
PixelLabel label_pixel(std::span<const SubRay> rays, float phase_cycles, double wavelength_m,
                       double sigma_m);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/camera.hpp>

namespace tofmap {

/// An organised cloud in less than a sixth of the memory of a SurfaceCloud: what registration and
/// the map need of a frame that is kept.
///
/// A pixel takes eight bytes before compression: the range in multiples of a step, the normal in
/// octahedral coordinates of 12 bits each (Meyer et al., "On floating-point normal vectors", EGSR
/// 2010), both standard deviations with four significant bits, and the confidence in 250ths. The
/// bytes are compressed by zlib.
///
/// The error of a range is at most an eighth of a millimetre up to 16 m, a quarter up to 32 m and
/// so on; that of a normal is at most 0.001 rad, that of a standard deviation 3.2 %, and that of a
/// confidence 0.002. Standard deviations are limited to 0.00006 … 3.8.
struct CompactCloud {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> bytes;
  std::string origin = {};  ///< names the cloud in messages, such as a file; may be empty
};

/// Makes a cloud compact. Its points must be on the rays of their pixels, as those of
/// surface_cloud() are. Negative confidences become −1. Throws UsageError if the cloud is not
/// organised, or if a point is farther away than 65 km.
CompactCloud compact(const SurfaceCloud& cloud);

/// The cloud of which compact() made this. `rays` are those of its camera. The result is the same
/// on every machine. Throws InputError if the bytes are damaged, or if the size is not that of the
/// camera's images.
SurfaceCloud expand(const CompactCloud& compact, const PixelRays& rays);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/acquisition/kinect2/p0_tables.hpp>

namespace tofmap {

/// Phase offsets of a simulated Kinect v2. `seed` identifies the individual camera; the same seed
/// gives the same tables.
///
/// The offset of a pixel is a length by which its paths appear shorter, divided by each frequency's
/// wavelength. The length is 0.3316 m, as the values 0x2c9a, 0x08ec and 0x42e8 say that
/// libfreenect2 notes for columns 0 and 511 of a real camera (protocol/response.h) and that these
/// tables have there, too: all three are that length. How much it differs over the image is not
/// known; assumed are a smooth pattern of up to ±20 mm, a deviation of each pixel with a standard
/// deviation of 2 mm, and one of each pixel and frequency of 1 mm.
kinect2::P0Tables synthetic_p0_tables(int seed);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <tofmap/core/image.hpp>

namespace tofmap::kinect2 {

inline constexpr int image_width_px = 512;
inline constexpr int image_height_px = 424;

/// Size of a packet: 10 sub-images of 512 x 424 codes of 11 bits.
inline constexpr std::size_t packet_bytes = 2'984'960;

/// The modulation frequencies, in the order in which a packet holds them. Their wavelengths are
/// 1.874, 9.369 and 1.249 m; the combined range of all three is 18.74 m.
inline constexpr std::array<double, 3> frequencies_hz{80e6, 16e6, 120e6};

/// Correlation images of one frequency. Step k is shifted by k thirds of a cycle.
using Steps = std::array<Image<std::int16_t>, 3>;

/// What the camera measures in one frame: `steps[frequency][step]`, images of 424 rows and 512
/// columns in the camera's units, positive or negative. A pixel that was saturated is
/// `saturated_measurement`. Columns 0 and 511 hold nothing and are 0.
///
/// Row 0 is the top of the scene. Columns are as the camera sends them, which is mirrored: column 0
/// is the right end of what the camera sees (mirror.hpp).
struct Measurements {
  std::array<Steps, 3> steps;
};

/// Decodes a packet, as the depth stream of a Kinect v2 delivers it and libfreenect2's dump
/// pipeline passes it on.
///
/// A packet consists of 10 sub-images: three steps at 80 MHz, three at 16 MHz, three at 120 MHz,
/// and one of unknown purpose, which is ignored. A sub-image has 424 rows of 704 bytes, which hold
/// 512 companded codes (companding.hpp) of 11 bits, least significant bits first. The code of
/// column x is at position ⌊x / 4⌋ + 128 (x mod 4) of its row. Image rows 0 to 211 are stored in
/// this order; rows 212 to 423 follow in reverse order, row 423 first.
///
/// Source: libfreenect2, cpu_depth_packet_processor.cpp, whose images are turned upside down
/// at the end; these rows are those after that.
///
/// Throws InputError if the size is not `packet_bytes`. Every packet of this size can be decoded.
Measurements decode_packet(std::span<const std::uint8_t> packet);

/// Encodes measurements as a packet: the inverse of decode_packet(), with each measurement rounded
/// to that of the nearest code. Columns 0 and 511 and the tenth sub-image become 0.
///
/// Throws UsageError if an image does not have 424 rows and 512 columns.
std::vector<std::uint8_t> encode_packet(const Measurements& measurements);

/// Reads and decodes a packet file. Throws InputError, which names the file, if the file is
/// missing, cannot be read, or does not have `packet_bytes`.
Measurements read_packet(const std::filesystem::path& file);

}  // namespace tofmap::kinect2

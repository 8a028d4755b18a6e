// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>

#include <tofmap/core/image.hpp>

namespace tofmap::kinect2 {

/// Phase of one unit of a P0 table, in cycles. libfreenect2 has it as an angle, 0.000031 π.
inline constexpr double cycles_per_p0_unit = 0.0000155;

/// The phase offsets of every pixel at each frequency, which the maker measured for each camera.
/// Tables of another camera do not fit.
struct P0Tables {
  /// One table a frequency, in the order of `frequencies_hz`: 424 rows of 512 values in units of
  /// `cycles_per_p0_unit`. Rows and columns are those of Measurements.
  std::array<ImageU16, 3> tables;
};

/// Reads P0 tables from either form in which programs keep them:
/// - the camera's answer to the request for its P0 tables, 1 302 572 bytes or more: 8 words of 32
///   bits, then for each frequency a word of 16 bits, the 512 x 424 values of 16 bits, and a word
///   of 16 bits. Recordings have it as calibration/p0.bin. What the words mean is unknown; they are
///   ignored, as is what follows the last table.
/// - the values alone, 1 302 528 bytes.
///
/// Source of the layout: libfreenect2, protocol/response.h. All words are little-endian.
///
/// Throws InputError, which names the file and says where such a file comes from, if the file is
/// missing, cannot be read, or has another size.
P0Tables read_p0_tables(const std::filesystem::path& file);

/// Writes P0 tables in the form of the camera's answer. Its first and fourth word are the sizes of
/// the header and of a table in bytes, the others are 0. Throws UsageError if a table does not have
/// 424 rows and 512 columns, and InputError, which names the file, if it cannot be written.
void write_p0_tables(const std::filesystem::path& file, const P0Tables& tables);

}  // namespace tofmap::kinect2

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <tiffio.h>
#include <zip.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap::test {

/// The message of the InputError that `call` throws; empty if it throws none.
template <class Call>
std::string input_error(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The numbers as a file stores them.
template <class Number>
std::string bytes_of(const std::vector<Number>& numbers, bool big_endian = false) {
  std::string bytes;
  for (const Number number : numbers) {
    char buffer[sizeof number];
    std::memcpy(buffer, &number, sizeof number);
    if (big_endian) std::reverse(buffer, buffer + sizeof number);
    bytes.append(buffer, sizeof number);
  }
  return bytes;
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A .npy file with this text as its header.
inline std::string npy_with_header(std::string header, const std::string& data, int version = 1) {
  const std::size_t start = version == 1 ? 10 : 12;
  while ((start + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string bytes = std::string("\x93NUMPY") + static_cast<char>(version) + '\0';
  const std::size_t length = header.size();
  for (std::size_t i = 0; i < start - 8; ++i) {
    bytes += static_cast<char>((length >> (8 * i)) & 255);
  }
  return bytes + header + data;
}

/// A .npy file, `shape` as in "(2, 3)".
inline std::string npy(const std::string& type, const std::string& shape, const std::string& data,
                       bool fortran_order = false, int version = 1) {
  return npy_with_header("{'descr': '" + type + "', 'fortran_order': " +
                             (fortran_order ? "True" : "False") + ", 'shape': " + shape + ", }",
                         data, version);
}

/// Writes a .npz file with these members, names with ".npy".
inline void write_npz(const std::filesystem::path& file,
                      const std::vector<std::pair<std::string, std::string>>& members,
                      bool deflate) {
  int error = 0;
  zip_t* archive = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
  if (archive == nullptr) throw std::runtime_error("no zip archive");
  for (const auto& [name, bytes] : members) {
    zip_source_t* source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
    const zip_int64_t index = zip_file_add(archive, name.c_str(), source, ZIP_FL_OVERWRITE);
    zip_set_file_compression(archive, static_cast<zip_uint64_t>(index),
                             deflate ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 0);
  }
  if (zip_close(archive) != 0) throw std::runtime_error("zip archive not written");
}

/// Writes gray images of 16 bits as the pages of a TIFF file.
inline void write_tiff(const std::filesystem::path& file, const std::vector<ImageU16>& pages,
                       int compression = COMPRESSION_NONE) {
  TIFF* tiff = TIFFOpen(file.c_str(), "w");
  if (tiff == nullptr) throw std::runtime_error("no TIFF file");
  for (const ImageU16& page : pages) {
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(page.cols()));
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(page.rows()));
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 2);
    for (Eigen::Index row = 0; row < page.rows(); ++row) {
      ImageU16 line = page.row(row);
      TIFFWriteScanline(tiff, line.data(), static_cast<std::uint32_t>(row));
    }
    TIFFWriteDirectory(tiff);
  }
  TIFFClose(tiff);
}

/// What a made-up camera sees: phases in cycles and amplitudes of a pixel.
struct MadeUpScene {
  int rows = 3;
  int cols = 5;
  double offset = 2000;  ///< b

  double phase(int frame, int frequency, int row, int col) const {
    const double cycles = 0.03 + 0.11 * frame + 0.23 * frequency + 0.17 * row + 0.061 * col;
    return cycles - std::floor(cycles);
  }
  double amplitude(int frequency, int row, int col) const {
    return 500 + 40 * frequency + 30 * row + 10 * col;
  }
  /// I = b + a cos(2π φ − θ), rounded.
  double value(int frame, int frequency, double angle_deg, int row, int col) const {
    const double angle = 2 * std::numbers::pi * phase(frame, frequency, row, col) -
                         angle_deg * std::numbers::pi / 180;
    return std::round(offset + amplitude(frequency, row, col) * std::cos(angle));
  }
};

/// The distance of two phases around the circle.
inline double phase_difference(double one, double other) {
  return std::abs(one - other - std::round(one - other));
}

}  // namespace tofmap::test

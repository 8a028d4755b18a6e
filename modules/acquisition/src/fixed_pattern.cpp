// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/fixed_pattern.hpp"

#include "correlation/sizes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include <tofmap/acquisition/correlation/array_file.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {
namespace {

constexpr const char* wanted_array =
    "a pattern is a float32 array of shape (frequencies, rows, columns), in metres";

std::string shape_text(const std::vector<std::int64_t>& sizes) {
  return fmt::format("({})", fmt::join(sizes, ", "));
}

/// Throws InputError if the array cannot be a pattern.
void check_array(const ArrayFile& array) {
  if (array.type().kind != ElementType::Kind::floating_point || array.type().bytes != 4) {
    throw InputError("holds numbers of type " + text_of(array.type()) + "; " + wanted_array +
                     ": save array.astype('float32')");
  }
  const std::vector<std::int64_t>& sizes = array.sizes();
  if (sizes.size() != 3 || sizes[0] > static_cast<std::int64_t>(most_frequencies)) {
    throw InputError("has the shape " + shape_text(sizes) + "; " + wanted_array);
  }
  if (array.fortran_order()) {
    throw InputError(
        "is stored column by column (fortran_order); save numpy.ascontiguousarray(array)");
  }
  if (array.elements_present() < product(sizes)) {
    throw InputError("is truncated: it holds " + std::to_string(array.elements_present()) +
                     " of the " + std::to_string(product(sizes)) +
                     " numbers of its shape; copy it again, or calibrate again");
  }
}

ImageF image_of(const std::vector<std::byte>& bytes, Eigen::Index rows, Eigen::Index cols,
                bool big_endian) {
  ImageF image(rows, cols);
  for (Eigen::Index i = 0; i < image.size(); ++i) {
    image.data()[i] = stored_number<float>(
        bytes.data() + sizeof(float) * static_cast<std::size_t>(i), big_endian);
  }
  return image;
}

/// Throws InputError if the image has no error that a camera may have. `frequency` counts from 0.
void check_errors(const ImageF& error_m, std::size_t frequency) {
  bool is_known = false;
  for (const float error : error_m.reshaped<Eigen::AutoOrder>()) {
    if (std::isnan(error)) continue;
    is_known = true;
    if (std::abs(error) <= largest_pattern_error_m) continue;
    throw InputError(fmt::format(
        "has a pixel with an error of {:g} m at frequency {}; errors are at most {:g} m: are they "
        "metres? Write NaN for pixels that are of no use",
        error, frequency + 1, largest_pattern_error_m));
  }
  if (is_known) return;
  throw InputError("has only NaN at frequency " + std::to_string(frequency + 1) +
                   "; write 0 for a frequency without a pattern");
}

FixedPattern pattern_in(ArrayFile& array) {
  check_array(array);
  const std::int64_t frequencies = array.sizes()[0];
  const std::int64_t pixels = product(array.sizes(), 1);
  FixedPattern pattern;
  for (std::int64_t f = 0; f < frequencies; ++f) {
    pattern.push_back(image_of(array.read(f * pixels, pixels), array.sizes()[1], array.sizes()[2],
                               array.type().big_endian));
    check_errors(pattern.back(), pattern.size() - 1);
  }
  return pattern;
}

/// The beginning of a .npy file of format version 1.0 (NEP 1 of numpy), with the byte order of this
/// machine.
std::string npy_start(std::size_t frequencies, Eigen::Index rows, Eigen::Index cols) {
  const char order = std::endian::native == std::endian::little ? '<' : '>';
  std::string header =
      fmt::format("{{'descr': '{}f4', 'fortran_order': False, 'shape': ({}, {}, {}), }}", order,
                  frequencies, rows, cols);
  constexpr std::size_t before_header = 10;
  constexpr std::size_t alignment = 64;  // of the first number
  const std::size_t unaligned = (before_header + header.size() + 1) % alignment;
  header += std::string((alignment - unaligned) % alignment, ' ') + '\n';
  std::string start = "\x93NUMPY";
  start += '\x01';
  start += '\0';
  start += static_cast<char>(header.size() % 256);
  start += static_cast<char>(header.size() / 256);
  return start + header;
}

}  // namespace

FixedPattern read_fixed_pattern(const std::filesystem::path& file) {
  refuse_no_file(file);
  if (!std::filesystem::exists(file)) {
    throw InputError(file.string() +
                     ": does not exist, but a calibration names it as its fixed_pattern; keep both "
                     "files in one folder, or take the line fixed_pattern out of the calibration");
  }
  ArrayFile array(file, {});
  return naming(file.string(), [&] { return pattern_in(array); });
}

void write_fixed_pattern(const std::filesystem::path& file, const FixedPattern& pattern) {
  if (pattern.empty()) throw UsageError("write_fixed_pattern: the pattern has no image");
  const ImageF& first = pattern.front();
  if (!std::ranges::all_of(pattern, [&](const ImageF& one) { return same_size(one, first); })) {
    throw UsageError("write_fixed_pattern: the images of the pattern differ in size");
  }
  std::ofstream out(file, std::ios::binary);
  const std::string start = npy_start(pattern.size(), first.rows(), first.cols());
  out.write(start.data(), static_cast<std::streamsize>(start.size()));
  for (const ImageF& error_m : pattern) {
    out.write(reinterpret_cast<const char*>(error_m.data()),
              static_cast<std::streamsize>(sizeof(float)) * error_m.size());
  }
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written; is the disk full?");
}

void check_fixed_pattern(const FixedPattern& pattern, std::size_t frequencies, int width_px,
                         int height_px) {
  if (pattern.empty()) return;
  const bool fits =
      pattern.size() == frequencies && std::ranges::all_of(pattern, [&](const ImageF& error_m) {
        return error_m.rows() == height_px && error_m.cols() == width_px;
      });
  if (fits) return;
  throw InputError(fmt::format(
      "the fixed pattern has the shape ({}, {}, {}), but the camera has the shape ({}, {}, {}) of "
      "frequencies, rows and columns; does it belong to another camera?",
      pattern.size(), pattern.front().rows(), pattern.front().cols(), frequencies, height_px,
      width_px));
}

void subtract_fixed_pattern(Frame& frame, const Modulation& modulation,
                            const FixedPattern& pattern) {
  for (std::size_t f = 0; f < pattern.size(); ++f) {
    const auto cycles_per_m = static_cast<float>(1 / modulation.wavelength_m(f));
    float* const phase = frame.phases[f].data();
    const float* const error_m = pattern[f].data();
    for (Eigen::Index i = 0; i < frame.phases[f].size(); ++i) {
      if (std::isnan(error_m[i])) continue;
      const float corrected = phase[i] - cycles_per_m * error_m[i];
      const float whole = corrected - std::floor(corrected);
      phase[i] = whole >= 1 ? 0 : whole;  // rounding may give a whole cycle; NaN stays NaN
    }
  }
}

}  // namespace tofmap

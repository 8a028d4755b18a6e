// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include <tofmap/acquisition/kinect2/p0_tables.hpp>
#include <tofmap/acquisition/kinect2/packet.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap::test {

/// The message of the InputError that `call` throws; a failure of the test if it throws none.
template <class Call>
std::string input_error(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError";
  return "";
}

/// Expects that `text` holds `part`.
inline void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

/// Measurements of all magnitudes and both signs, another image for each step and number, that a
/// packet stores without rounding. The outermost columns are 0.
inline kinect2::Measurements sample_measurements(int number = 0) {
  kinect2::Measurements measurements;
  int image_number = 10 * number;
  for (kinect2::Steps& steps : measurements.steps) {
    for (Image<std::int16_t>& image : steps) {
      image.setZero(kinect2::image_height_px, kinect2::image_width_px);
      for (Eigen::Index v = 0; v < image.rows(); ++v) {
        for (Eigen::Index u = 1; u + 1 < image.cols(); ++u) {
          const auto magnitude = (29 * v + 7 * u + 13 * image_number) % 256;  // 8 bits: exact
          const auto shift = (v + u) % 7;
          const bool is_negative = (3 * u + v + image_number) % 5 < 2;
          image(v, u) =
              static_cast<std::int16_t>(is_negative ? -(magnitude << shift) : magnitude << shift);
        }
      }
      ++image_number;
    }
  }
  return measurements;
}

/// True if all images have the same sizes and values.
inline bool same_measurements(const kinect2::Measurements& a, const kinect2::Measurements& b) {
  for (std::size_t f = 0; f < a.steps.size(); ++f) {
    for (std::size_t k = 0; k < a.steps[f].size(); ++k) {
      const auto& left = a.steps[f][k];
      const auto& right = b.steps[f][k];
      if (!same_size(left, right) || !(left == right).all()) return false;
    }
  }
  return true;
}

/// Tables whose values differ between all frequencies, rows and columns.
inline kinect2::P0Tables sample_p0_tables() {
  kinect2::P0Tables p0;
  for (int f = 0; f < 3; ++f) {
    ImageU16& table = p0.tables[f];
    table.resize(kinect2::image_height_px, kinect2::image_width_px);
    for (Eigen::Index i = 0; i < table.size(); ++i) {
      table.data()[i] = static_cast<std::uint16_t>(9001 * (f + 1) + 31 * i + i / 512);
    }
  }
  return p0;
}

}  // namespace tofmap::test

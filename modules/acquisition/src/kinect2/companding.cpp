// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/kinect2/companding.hpp"

#include <bit>
#include <cstdlib>
#include <string>

#include <tofmap/core/error.hpp>

namespace tofmap::kinect2 {
namespace {

/// Codes of one step size. Magnitudes have 8 significant bits: the first of them is always 1 from
/// the second segment on, so that a code stores the other 7.
constexpr int segment = 128;
constexpr int significant_bits = 8;

}  // namespace

std::int16_t measurement_of_code(int code) {
  if (code < 0 || code >= code_count) {
    throw UsageError("the code " + std::to_string(code) + " does not exist; codes are 0 to 2047");
  }
  if (code == saturation_code) return saturated_measurement;
  const bool is_negative = code > saturation_code;
  const int positive = is_negative ? code - saturation_code : code;
  const int shift = positive < segment ? 0 : positive / segment - 1;
  const int significand = positive < segment ? positive : segment + positive % segment;
  const int magnitude = significand << shift;
  return static_cast<std::int16_t>(is_negative ? -magnitude : magnitude);
}

int nearest_code(int measurement) {
  constexpr int first_saturated = 16352;  // halfway between code 1023 and what would be code 1024
  if (measurement >= first_saturated || measurement <= -first_saturated) return saturation_code;
  const int magnitude = std::abs(measurement);
  int code = magnitude;
  if (magnitude >= segment) {
    int shift =
        static_cast<int>(std::bit_width(static_cast<unsigned>(magnitude))) - significant_bits;
    int significand = (magnitude + ((1 << shift) >> 1)) >> shift;
    if (significand == 2 * segment) {  // rounded up to the first magnitude of the next segment
      significand = segment;
      ++shift;
    }
    code = (shift + 1) * segment + significand - segment;
  }
  return measurement < 0 ? code + saturation_code : code;
}

}  // namespace tofmap::kinect2

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <tofmap/acquisition/correlation/array_layout.hpp>
#include <tofmap/acquisition/correlation/element_type.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// How the numbers in a file become values of correlation images.
///
/// An integer is a code: it is shifted to the right by `shift` bits and cut to `bits` bits, and,
/// if it is signed, its highest bit is its sign. With a companding table the value is the table's
/// entry of the code, else the code itself. Floating-point numbers are values as they are.
struct StepValues {
  int bits = 0;   ///< valid bits of an integer; 0: all
  int shift = 0;  ///< bits below them that mean nothing
  /// Whether integers are in two's complement. Empty: if the file's type is signed.
  std::optional<bool> is_signed = {};
  std::vector<float> companding = {};              ///< value of each code; empty: no companding
  std::vector<std::int64_t> saturated_codes = {};  ///< a pixel with one of them is saturated
  double saturated_from = std::numeric_limits<double>::infinity();    ///< from this value on
  double saturated_up_to = -std::numeric_limits<double>::infinity();  ///< up to this value
};

/// One correlation image.
struct StepImage {
  ImageF values;
  ImageU8 saturated;           ///< 1 in saturated pixels, else 0
  bool whole_numbers = false;  ///< values are rounded to whole numbers
};

/// Throws InputError, which names the key and what is allowed, if the values cannot be of this
/// type: more bits than it has, or codes and bits of floating-point numbers.
void check_values(const StepValues& values, const ElementType& type);

/// The image that starts with element number `first` of a frame's bytes, which read_frame() gave.
/// Throws InputError if the companding table has no entry for a code.
StepImage step_image(std::span<const std::byte> frame, const ElementType& type,
                     const ArrayLayout& layout, std::int64_t first, const StepValues& values);

/// Codes up to `codes` − 1 whose magnitudes grow piece by piece: from `code` on, by `step` a code,
/// from `value` on.
struct CompandingSegment {
  int code = 0;
  double value = 0;
  double step = 1;
};

/// The value of each code, 0 … codes − 1. From the code `negative_from` on, values are the negative
/// ones of the codes from 0 on; 0: there are none. `segments` must be in ascending order of codes
/// and begin with code 0.
std::vector<float> companding_table(const std::vector<CompandingSegment>& segments, int codes,
                                    int negative_from);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/correlation/step_values.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Turns integers of one type into values.
class CodeReader {
 public:
  CodeReader(const StepValues& values, const ElementType& type)
      : values_(values),
        is_signed_(values.is_signed.value_or(type.kind == ElementType::Kind::signed_integer)) {
    const int bits = values.bits > 0 ? values.bits : 8 * type.bytes - values.shift;
    mask_ = ~std::uint64_t{0} >> (64 - bits);
    sign_ = std::uint64_t{1} << (bits - 1);
  }

  /// The value of a code; sets `saturated` if it is one of the saturated codes.
  float value(std::uint64_t stored, std::uint8_t& saturated) const {
    const std::uint64_t code = (stored >> values_.shift) & mask_;
    const bool is_negative = is_signed_ && (code & sign_) != 0;
    const std::uint64_t magnitude = is_negative ? (~code + 1) & mask_ : code;
    if (!values_.saturated_codes.empty()) {
      const auto number = static_cast<std::int64_t>(magnitude);
      const std::int64_t wanted = is_negative ? -number : number;
      saturated |=
          std::ranges::find(values_.saturated_codes, wanted) != values_.saturated_codes.end();
    }
    if (values_.companding.empty()) {
      return is_negative ? -static_cast<float>(magnitude) : static_cast<float>(magnitude);
    }
    if (code < values_.companding.size()) return values_.companding[code];
    throw InputError("has the code " + std::to_string(code) +
                     ", but the table of companding ends with code " +
                     std::to_string(values_.companding.size() - 1));
  }

 private:
  const StepValues& values_;
  bool is_signed_;
  std::uint64_t mask_ = 0;
  std::uint64_t sign_ = 0;
};

}  // namespace

void check_values(const StepValues& values, const ElementType& type) {
  const bool needs_codes = values.bits > 0 || values.shift > 0 || values.is_signed ||
                           !values.companding.empty() || !values.saturated_codes.empty();
  if (!type.is_integer() && needs_codes) {
    throw InputError("holds " + text_of(type) +
                     ", but values.bits, shift, signed, companding and saturation.codes are for "
                     "whole numbers; leave them out");
  }
  const int bits = values.bits > 0 ? values.bits : 1;
  if (type.is_integer() && bits + values.shift > 8 * type.bytes) {
    throw InputError("holds " + text_of(type) + ", but values.bits and values.shift are " +
                     std::to_string(values.bits) + " and " + std::to_string(values.shift) +
                     "; allowed: together at most " + std::to_string(8 * type.bytes));
  }
}

StepImage step_image(std::span<const std::byte> frame, const ElementType& type,
                     const ArrayLayout& layout, std::int64_t first, const StepValues& values) {
  const Eigen::Index rows = layout.size(ArrayAxis::row);
  const Eigen::Index cols = layout.size(ArrayAxis::column);
  const std::int64_t row_stride = layout.stride_in_frame(ArrayAxis::row);
  const std::int64_t col_stride = layout.stride_in_frame(ArrayAxis::column);
  const CodeReader codes(values, type);
  StepImage image{ImageF(rows, cols), ImageU8::Zero(rows, cols), type.is_integer()};
  with_number_type(type, [&](auto number) {
    using Number = decltype(number);
    for (Eigen::Index row = 0; row < rows; ++row) {
      for (Eigen::Index col = 0; col < cols; ++col) {
        const std::int64_t element = first + row * row_stride + col * col_stride;
        const auto stored = stored_number<Number>(
            &frame[static_cast<std::size_t>(element * type.bytes)], type.big_endian);
        std::uint8_t& saturated = image.saturated(row, col);
        float& value = image.values(row, col);
        if constexpr (std::is_integral_v<Number>) {
          value = codes.value(static_cast<std::uint64_t>(stored), saturated);
        } else {
          value = static_cast<float>(stored);
        }
        if (!std::isfinite(value)) continue;  // no measurement, saturated or not
        saturated |= value >= values.saturated_from || value <= values.saturated_up_to;
      }
    }
  });
  return image;
}

std::vector<float> companding_table(const std::vector<CompandingSegment>& segments, int codes,
                                    int negative_from) {
  const int positive = negative_from > 0 ? std::min(negative_from, codes) : codes;
  std::vector<float> table;
  for (int code = 0; code < positive; ++code) {
    const auto next = std::ranges::upper_bound(segments, code, {}, &CompandingSegment::code);
    const CompandingSegment& segment = *(next - 1);
    table.push_back(static_cast<float>(segment.value + (code - segment.code) * segment.step));
  }
  for (int code = positive; code < codes; ++code) {
    table.push_back(-table[static_cast<std::size_t>(code - positive)]);
  }
  return table;
}

}  // namespace tofmap

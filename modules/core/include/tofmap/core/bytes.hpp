// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <tofmap/core/error.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "stored numbers are little-endian");

/// Writes numbers and images one after the other, little-endian and exact to the bit.
class ByteWriter {
 public:
  template <class Number>
  void number(const Number& number) {
    static_assert(std::is_arithmetic_v<Number>);
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }

  void numbers(std::span<const double> numbers) {
    for (const double one : numbers) number(one);
  }
  void numbers(std::span<const float> numbers) {
    for (const float one : numbers) number(one);
  }

  /// Writes whether the image is empty, then its pixels row by row.
  template <class Scalar>
  void image(const Image<Scalar>& image) {
    number<std::uint8_t>(image.size() == 0 ? 0 : 1);
    bytes_.append(reinterpret_cast<const char*>(image.data()),
                  static_cast<std::size_t>(image.size()) * sizeof(Scalar));
  }

  /// What was written so far. The writer is empty afterwards.
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what a ByteWriter wrote, but trusts nothing: throws InputError if the bytes end early or a
/// number is not finite. Images may hold any floats. `bytes` must outlive the reader.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <class Number>
  Number number() {
    static_assert(std::is_arithmetic_v<Number> && !std::is_same_v<Number, bool>);
    Number number{};
    take(&number, sizeof number);
    if constexpr (std::is_floating_point_v<Number>) {
      if (!std::isfinite(number)) throw InputError("a stored number is not finite");
    }
    return number;
  }

  /// A number from `least` to `most`.
  template <class Number>
  Number number(Number least, Number most) {
    const auto read = number<Number>();
    if (read < least || read > most) throw InputError("a stored number is out of its range");
    return read;
  }

  void numbers(std::span<double> numbers) {
    for (double& one : numbers) one = number<double>();
  }
  void numbers(std::span<float> numbers) {
    for (float& one : numbers) one = number<float>();
  }

  /// An image of this size, or an empty one.
  template <class Scalar>
  Image<Scalar> image(Eigen::Index rows, Eigen::Index cols) {
    Image<Scalar> image;
    if (number<std::uint8_t>(0, 1) == 0) return image;
    if (bytes_.size() < static_cast<std::size_t>(rows * cols) * sizeof(Scalar)) ends_early();
    image.resize(rows, cols);
    take(image.data(), static_cast<std::size_t>(image.size()) * sizeof(Scalar));
    return image;
  }

  /// Throws InputError unless all bytes were read.
  void expect_end() const {
    if (!bytes_.empty()) throw InputError("stored bytes are too many");
  }

 private:
  [[noreturn]] static void ends_early() { throw InputError("stored bytes end early"); }

  void take(void* to, std::size_t size) {
    if (bytes_.size() < size) ends_early();
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }

  std::string_view bytes_;
};

}  // namespace tofmap

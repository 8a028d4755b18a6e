// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <tofmap/acquisition/correlation/element_type.hpp>

struct tiff;

namespace tofmap {

/// The pages of a TIFF file: gray images of one size and type.
class TiffPages {
 public:
  /// Throws InputError, which names the file, if it is no TIFF file or its first page is no gray
  /// image of 8, 16, 32 or 64 bits in strips.
  explicit TiffPages(const std::filesystem::path& file);

  std::int64_t pages() const { return pages_; }
  std::int64_t rows() const { return rows_; }
  std::int64_t cols() const { return cols_; }
  const ElementType& type() const { return type_; }

  /// The elements of a page, row by row. Throws InputError, without the name of the file, if the
  /// page is damaged or unlike the first one.
  std::vector<std::byte> read(std::int64_t page);

 private:
  struct Closer {
    void operator()(tiff* file) const;
  };

  void read_tags();
  void go_to(std::int64_t page);

  std::unique_ptr<std::string> message_;  ///< of the last error; libtiff keeps its address
  std::unique_ptr<tiff, Closer> file_;
  std::int64_t page_ = 0;  ///< the current one
  std::int64_t pages_ = 0;
  std::int64_t rows_ = 0;
  std::int64_t cols_ = 0;
  ElementType type_;
};

}  // namespace tofmap

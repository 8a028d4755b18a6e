// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/correlation/element_type.hpp>

namespace tofmap {

/// What an array file does not say itself.
struct ArrayFileOptions {
  /// The array of a .npz file, with or without ".npy". Empty: the only one.
  std::string member = {};
  /// The type of the numbers in a raw binary file. Must be empty for other files.
  std::optional<ElementType> raw_type = {};
  /// Bytes before the first number of a raw binary file.
  std::int64_t raw_offset_bytes = 0;
};

struct ArrayContent;

/// A file that holds one array of numbers, by the ending of its name:
///
///   .npy         numpy's format, versions 1 to 3
///   .npz         a zip archive of them, stored or deflated
///   .png         one gray image of 16 bits
///   .tif, .tiff  gray images of 8, 16, 32 or 64 bits, one per page, in strips
///   any other    raw binary numbers
///
/// Elements are numbered in the order in which the file stores them. Any of them can be read
/// without reading the whole file; a deflated member of a .npz file is fast to read only in
/// ascending order. One object must not be used by two threads at once.
class ArrayFile {
 public:
  /// What the file says about the sizes of its array.
  enum class Shape {
    exact,   ///< sizes() are those of the array (.npy, .npz)
    pages,   ///< sizes() are pages, rows and columns; an array may be stacked in them in any way
    unknown  ///< sizes() is the number of whole elements (raw binary files)
  };

  /// Opens the file and reads its header. Throws InputError, which names the file, if it is missing
  /// or damaged, or holds something other than an array of numbers. A file that is shorter than its
  /// header says is opened: see elements_present().
  ArrayFile(const std::filesystem::path& file, const ArrayFileOptions& options);
  ArrayFile(ArrayFile&&) noexcept;
  ArrayFile& operator=(ArrayFile&&) noexcept;
  ~ArrayFile();

  const std::filesystem::path& path() const;
  const ElementType& type() const;
  Shape shape() const;

  /// The sizes of the array. The index that varies slowest in the file is the first one; it is the
  /// last one if fortran_order().
  const std::vector<std::int64_t>& sizes() const;
  bool fortran_order() const;

  /// Number of whole elements in the file, which is less than the product of sizes() if the file is
  /// truncated.
  std::int64_t elements_present() const;

  /// The bytes of `count` elements from element number `first` on. Throws InputError, which names
  /// the file, if the file is too short or damaged there.
  std::vector<std::byte> read(std::int64_t first, std::int64_t count);

 private:
  std::unique_ptr<ArrayContent> content_;
};

}  // namespace tofmap

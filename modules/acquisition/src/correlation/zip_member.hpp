// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

struct zip;
struct zip_file;

namespace tofmap {

/// The uncompressed bytes of one array in a .npz file, which is a zip archive. Reading backwards
/// starts again at the beginning of the array.
class ZipMember {
 public:
  /// Opens the member `name` or `name`.npy; an empty name stands for the only array in the archive.
  /// Throws InputError, which names the file, if the archive is damaged, has no such member, or
  /// has several and `name` is empty.
  ZipMember(const std::filesystem::path& file, const std::string& name);

  /// As the archive's directory says.
  std::int64_t size() const { return size_; }

  /// Fills `to` with the bytes from `first` on. Throws InputError, without the name of the file, if
  /// the archive is damaged there. A wrong checksum is noticed when the last byte is read.
  void read(std::int64_t first, std::span<std::byte> to);

 private:
  struct Closer {
    void operator()(zip* archive) const;
    void operator()(zip_file* member) const;
  };

  void rewind();
  void skip_to(std::int64_t first);
  void fill(std::span<std::byte> to);

  std::unique_ptr<zip, Closer> archive_;
  std::unique_ptr<zip_file, Closer> member_;  ///< must be closed before the archive
  std::uint64_t index_ = 0;
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;
};

}  // namespace tofmap

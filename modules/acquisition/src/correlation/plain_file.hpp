// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>

namespace tofmap {

/// The bytes of a file, read anywhere.
class PlainFile {
 public:
  /// Throws InputError, which names the file, if it cannot be opened.
  explicit PlainFile(const std::filesystem::path& file);

  std::int64_t size() const { return size_; }

  /// Fills `to` with the bytes from `first` on. Throws InputError, without the name of the file, if
  /// they cannot be read or the file ends before.
  void read(std::int64_t first, std::span<std::byte> to);

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Closer> file_;
  std::int64_t size_ = 0;
};

}  // namespace tofmap

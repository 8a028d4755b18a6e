// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plain_file.hpp"

#include <cerrno>
#include <string>
#include <system_error>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap {

PlainFile::PlainFile(const std::filesystem::path& file) {
  refuse_no_file(file);
  file_.reset(std::fopen(file.c_str(), "rb"));
  if (!file_) {
    throw InputError(file.string() + ": cannot be read: " + std::generic_category().message(errno));
  }
  size_ = static_cast<std::int64_t>(std::filesystem::file_size(file));
}

void PlainFile::read(std::int64_t first, std::span<std::byte> to) {
  errno = 0;
  if (::fseeko(file_.get(), first, SEEK_SET) == 0 &&
      std::fread(to.data(), 1, to.size(), file_.get()) == to.size()) {
    return;
  }
  throw InputError(errno != 0 ? "cannot be read: " + std::generic_category().message(errno)
                              : "is truncated");
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/output_file.hpp"

#include <fstream>
#include <string>

#include <unistd.h>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace fs = std::filesystem;

namespace {

/// The file that a link points to, so that the file is replaced and the link stays.
fs::path behind_links(const fs::path& file) {
  std::error_code error;
  if (!fs::is_symlink(file, error)) return file;
  const fs::path target = fs::weakly_canonical(file, error);
  return error ? file : target;
}

}  // namespace

OutputFile::OutputFile(const fs::path& file,
                       const std::function<bool(const fs::path& existing)>& may_replace)
    : file_(behind_links(file)), partial_(file_.string() + ".partial-" + std::to_string(getpid())) {
  if (file.empty()) throw UsageError("the file to write has no name");
  if (fs::is_directory(file)) {
    throw InputError(file.string() + ": is a folder; name a file in it");
  }
  if (fs::exists(file) && !may_replace(file)) {
    throw InputError(file.string() +
                     ": exists already, and is not a file that this command writes; choose another "
                     "name, or remove it");
  }
  std::error_code ignored;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), ignored);
  if (!std::ofstream(partial_)) {
    throw InputError(file.string() + ": cannot be written; choose a folder that is writable");
  }
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  fs::remove(partial_, ignored);
}

void OutputFile::commit() {
  std::error_code error;
  const auto size = fs::file_size(partial_, error);
  if (!error && size > 0) fs::rename(partial_, file_, error);
  if (error || size == 0) {
    throw InputError(file_.string() + ": could not be written; is the disk full?");
  }
}

}  // namespace tofmap::app

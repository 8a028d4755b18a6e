// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>

namespace tofmap::app {

/// A result in one file, which appears only when it is complete: a temporary file is written beside
/// it, and `commit` moves that into place. Without commit the temporary file is deleted, and an
/// earlier file stays as it is.
class OutputFile {
 public:
  /// Creates the folder of the file. Throws InputError, with the path and a remedy, if the file
  /// cannot be written, or exists already and `may_replace(existing)` is false. Throws UsageError
  /// if the path is empty.
  OutputFile(const std::filesystem::path& file,
             const std::function<bool(const std::filesystem::path& existing)>& may_replace);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// The file to be written; if a link was named, the file that it leads to.
  const std::filesystem::path& target() const { return file_; }

  /// The path of the temporary file, to be written before commit.
  const std::filesystem::path& path() const { return partial_; }

  /// Moves the temporary file into place. Throws InputError if that fails or the file is empty.
  void commit();

 private:
  std::filesystem::path file_;
  std::filesystem::path partial_;
};

}  // namespace tofmap::app

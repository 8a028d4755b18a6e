// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>

namespace tofmap::app {

/// A result of one file that appears only when it is whole: it is written beside its place, and
/// `commit` moves it there. Without commit nothing is left, and an earlier file stays.
class OutputFile {
 public:
  /// Makes the folder that the file is to be in. Throws InputError that names the file and the
  /// remedy if it cannot be written, or is there already and `may_replace` does not say that it may
  /// go; UsageError if the path is empty.
  OutputFile(const std::filesystem::path& file,
             const std::function<bool(const std::filesystem::path& existing)>& may_replace);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Where to write until commit.
  const std::filesystem::path& path() const { return partial_; }

  /// Moves it into place. Throws InputError if it is empty: then it could not be written.
  void commit();

 private:
  std::filesystem::path file_;
  std::filesystem::path partial_;
};

}  // namespace tofmap::app

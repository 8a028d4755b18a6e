// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tofmap::app {

/// What an output folder may replace, besides an empty folder.
enum class Replaces {
  results,     ///< an earlier result, but never a recording
  recordings,  ///< an earlier result or simulated recording
};

/// Whether a run was finished.
enum class Completeness {
  whole,
  interrupted,  ///< a partial result, which does not replace an earlier one
  taken_back,   ///< a result that is only to be looked at, which does not replace one either
  resumable,    ///< a partial result that continues the earlier one and replaces it
};

/// A result folder that appears only when it is complete: files are written into a temporary folder
/// beside it, which `commit` moves into place. Without commit the temporary folder is deleted.
///
/// An existing folder is replaced only if it is empty, or contains an earlier result of this
/// program and nothing else (file_list.hpp), so that no other data is lost. Refused are mount
/// points, read-only folders, and, unless the command makes recordings, folders that are or contain
/// a recording. If the path is a link, the folder that it points to is replaced and the link stays.
class OutputFolder {
 public:
  /// Follows the name of the result in that of the temporary folder, before a number.
  static constexpr const char* partial_suffix = ".partial-";

  /// Creates the temporary folder. Throws InputError, with the path and a remedy, if that fails or
  /// an existing folder may not be replaced. Throws UsageError if the path is empty.
  explicit OutputFolder(const std::filesystem::path& folder, Replaces replaces = Replaces::results);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();

  /// The temporary folder, to be written before commit.
  const std::filesystem::path& path() const { return partial_; }
  /// The path that the result will have, and has after `commit`. Commit may change it.
  const std::filesystem::path& final_path() const { return folder_; }

  /// Creates a folder inside the temporary folder and returns its path. Throws InputError if that
  /// fails.
  std::filesystem::path make(const std::string& name) const;

  /// Writes a text file into the temporary folder. Throws InputError if that fails.
  void write_text(const std::string& name, const std::string& text) const;

  /// Moves the temporary folder into place. It gets a numbered name beside final_path(), and a
  /// message on stderr says so, if the run was interrupted and there is an earlier result, or if a
  /// folder was created or changed there during the run. Files that tofmap did not write and that
  /// appeared in the earlier result at the last moment are kept beside it and named on stderr.
  /// Throws InputError if the folder cannot be moved; it then stays where it was written, which the
  /// message names.
  void commit(Completeness completeness = Completeness::whole);

  /// Keeps the temporary folder even without commit.
  void keep();

 private:
  void choose_free_name();
  void tell_other_name(const std::filesystem::path& wanted, Completeness completeness,
                       bool keeps_earlier) const;

  std::string earlier_;  ///< identity of the folder at the beginning; empty if there was none
  std::filesystem::path folder_;
  std::filesystem::path partial_;
  Replaces replaces_;
  bool is_committed_ = false;
};

}  // namespace tofmap::app

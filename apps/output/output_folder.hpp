// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tofmap::app {

/// What an output folder may take the place of, besides nothing and an empty folder.
enum class Replaces {
  results,     ///< an earlier result, but never a recording
  recordings,  ///< an earlier result or simulated recording
};

/// Whether a run came to its end.
enum class Completeness {
  whole,
  interrupted,  ///< an earlier result is not replaced by what was finished until then
  resumable,    ///< interrupted as well, but it goes on from the earlier result and replaces it
};

/// A result folder that appears only when it is whole: files are written into a folder beside
/// it, which `commit` moves into place. Without commit nothing is left.
///
/// An existing folder is replaced if it is empty or holds an earlier result of this program, and
/// nothing that the program did not write (file_list.hpp). Anything else is refused, so that no
/// data of others is lost. So is a folder that is or holds a recording, unless the command makes
/// recordings, a mount point, and a read-only folder. A link to a folder stays, and the folder is
/// replaced.
class OutputFolder {
 public:
  /// Throws InputError that names the folder and the remedy if it cannot be made, or is in use.
  explicit OutputFolder(const std::filesystem::path& folder, Replaces replaces = Replaces::results);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();

  /// Where to write until commit.
  const std::filesystem::path& path() const { return partial_; }
  /// Where the result will be, and after `commit` where it is.
  const std::filesystem::path& final_path() const { return folder_; }

  /// Makes a folder inside and returns its path.
  std::filesystem::path make(const std::string& name) const;

  /// Writes a text file inside. Throws InputError if it cannot be written whole.
  void write_text(const std::string& name, const std::string& text) const;

  /// Moves everything into place. What an interrupted run finished goes beside an earlier result,
  /// which may be whole, and a message says so. If something has come there meanwhile, the result
  /// goes beside it instead, and a message says so: nothing of either is lost. If it cannot be
  /// moved it stays where it was written, and the InputError names that. Files that came into the
  /// earlier result at the last moment are kept beside it, and named.
  void commit(Completeness completeness = Completeness::whole);

  /// Leaves what was written so far where it is if there is no commit.
  void keep();

 private:
  void choose_free_name();
  void tell_other_name(const std::filesystem::path& wanted, bool keeps_earlier) const;

  std::string earlier_;  ///< what stood in the folder's place at the beginning
  std::filesystem::path folder_;
  std::filesystem::path partial_;
  Replaces replaces_;
  bool is_committed_ = false;
};

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace tofmap::app {

/// Something in a result folder that the program did not write, or that was changed afterwards.
struct ForeignFile {
  std::filesystem::path path;  ///< relative to the folder
  bool is_changed = false;     ///< true if the program wrote it, but with other content
};

/// The files and folders that the program wrote into a result folder, files with their size and
/// checksum (CRC-32). The list is stored in the folder as `.tofmap-files`. It ensures that only
/// these files are deleted when the result is replaced.
class FileList {
 public:
  static constexpr const char* file_name = ".tofmap-files";

  /// Lists a file, or a folder with everything inside it, under the path `name`. If `name` is
  /// empty, lists only what is inside the folder. Throws InputError if something cannot be read, or
  /// is neither a file nor a folder.
  static FileList of(const std::filesystem::path& path, const std::filesystem::path& name = {});

  /// Reads the list of a folder. Empty if the folder has no valid list.
  static std::optional<FileList> read(const std::filesystem::path& folder);

  /// Adds the entries of another list of the same folder.
  void add(const FileList& more);

  /// Writes the list as a file. Throws InputError if it cannot be written.
  void write(const std::filesystem::path& file) const;

  /// The first file or folder, by name, that is not listed or was changed. Empty if there is none.
  /// Links are never listed. Throws InputError if the folder cannot be read.
  std::optional<ForeignFile> first_foreign(const std::filesystem::path& folder) const;

  /// Deletes the files of a folder that are listed and unchanged, then the list, then every listed
  /// folder that is empty, and the folder itself if it is empty. Returns whether the folder itself
  /// was deleted.
  bool remove_from(const std::filesystem::path& folder) const;

 private:
  struct Entry {
    bool is_folder = false;
    std::uintmax_t size_bytes = 0;
    std::uint32_t checksum = 0;

    bool operator==(const Entry&) const = default;
  };

  static Entry entry_of(const std::filesystem::path& path);
  bool holds(const std::filesystem::path& name, const std::filesystem::path& path) const;

  std::map<std::string, Entry> entries_;  ///< by path relative to the folder
};

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace tofmap::app {

/// Something in a result folder that the program did not write, or that was changed since.
struct ForeignFile {
  std::filesystem::path path;  ///< within the folder
  bool is_changed = false;     ///< the program wrote a file of this name, with another content
};

/// What the program wrote into a result folder: files with size and checksum (CRC-32), and folders.
/// It is kept in the folder as `.tofmap-files`, so that replacing a result deletes nothing else.
class FileList {
 public:
  static constexpr const char* file_name = ".tofmap-files";

  /// All that is at a path now, a folder with what it holds or one file, listed under `name`;
  /// without a name what the folder holds is listed, and not the folder. Throws InputError if
  /// something cannot be read, or is neither file nor folder.
  static FileList of(const std::filesystem::path& path, const std::filesystem::path& name = {});

  /// The list that a folder holds; nothing if it holds none that can be understood.
  static std::optional<FileList> read(const std::filesystem::path& folder);

  /// Adds the entries of another list of the same folder.
  void add(const FileList& more);

  /// Writes the list as a file. Throws InputError if it cannot be written whole.
  void write(const std::filesystem::path& file) const;

  /// What a folder holds besides what is listed, the first by name; nothing if there is nothing.
  /// Links are never listed. Throws InputError if the folder cannot be read.
  std::optional<ForeignFile> first_foreign(const std::filesystem::path& folder) const;

  /// Deletes the files of a folder that are listed and unchanged, the list, and then every listed
  /// folder that is empty. Returns whether the folder itself is gone: whether it held nothing else.
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

  std::map<std::string, Entry> entries_;  ///< by path within the folder
};

}  // namespace tofmap::app

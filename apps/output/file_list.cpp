// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/file_list.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <vector>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace fs = std::filesystem;
namespace {

constexpr const char* first_line =
    "# tofmap wrote what is listed here, and deletes nothing else: CRC-32, bytes, path";

std::uint32_t checksum_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  boost::crc_32_type checksum;
  std::array<char, 65536> block{};
  while (in.read(block.data(), block.size()) || in.gcount() > 0) {
    checksum.process_bytes(block.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (!in.eof()) throw InputError(file.string() + ": cannot be read");
  return checksum.checksum();
}

/// Runs a step that reads folders. A filesystem_error becomes an InputError.
template <class Step>
auto reading(const Step& step) {
  try {
    return step();
  } catch (const fs::filesystem_error& error) {
    throw InputError(error.path1().string() + ": cannot be read (" + error.code().message() + ")");
  }
}

template <class Number>
bool parse(const std::string& text, Number& number, int base) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number, base);
  return error == std::errc() && rest == end;
}

}  // namespace

FileList::Entry FileList::entry_of(const fs::path& path) {
  const fs::file_status status = fs::symlink_status(path);
  if (fs::is_directory(status)) return {.is_folder = true};
  if (!fs::is_regular_file(status)) {
    throw InputError(path.string() + ": is neither a file nor a folder");
  }
  return {.size_bytes = fs::file_size(path), .checksum = checksum_of(path)};
}

FileList FileList::of(const fs::path& path, const fs::path& name) {
  return reading([&] {
    FileList list;
    if (!name.empty()) list.entries_[name.string()] = entry_of(path);
    if (!fs::is_directory(path)) return list;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      const fs::path inside = entry.path().lexically_relative(path);
      if (inside == file_name) continue;
      list.entries_[(name / inside).string()] = entry_of(entry.path());
    }
    return list;
  });
}

std::optional<FileList> FileList::read(const fs::path& folder) {
  std::error_code ignored;
  const fs::path file = folder / file_name;
  if (!fs::is_regular_file(fs::symlink_status(file, ignored))) return std::nullopt;
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line) || line != first_line) return std::nullopt;
  FileList list;
  while (std::getline(in, line)) {
    const std::size_t one = line.find(' ');
    const std::size_t two = one == std::string::npos ? one : line.find(' ', one + 1);
    if (two == std::string::npos) return std::nullopt;
    Entry entry{.is_folder = line[0] == '-'};
    const bool is_understood =
        entry.is_folder || (parse(line.substr(0, one), entry.checksum, 16) &&
                            parse(line.substr(one + 1, two - one - 1), entry.size_bytes, 10));
    if (!is_understood) return std::nullopt;
    list.entries_[line.substr(two + 1)] = entry;
  }
  return list;
}

void FileList::add(const FileList& more) {
  for (const auto& [name, entry] : more.entries_) entries_[name] = entry;
}

void FileList::write(const fs::path& file) const {
  std::ofstream out(file, std::ios::binary);
  out << first_line << '\n';
  for (const auto& [name, entry] : entries_) {
    out << (entry.is_folder ? "- -" : fmt::format("{:08x} ", entry.checksum))
        << (entry.is_folder ? "" : std::to_string(entry.size_bytes)) << ' ' << name << '\n';
  }
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written; is the disk full?");
}

bool FileList::holds(const fs::path& name, const fs::path& path) const {
  const auto found = entries_.find(name.string());
  if (found == entries_.end()) return false;
  const fs::file_status status = fs::symlink_status(path);
  const Entry& entry = found->second;
  if (entry.is_folder) return fs::is_directory(status);
  return fs::is_regular_file(status) && fs::file_size(path) == entry.size_bytes &&
         checksum_of(path) == entry.checksum;
}

std::optional<ForeignFile> FileList::first_foreign(const fs::path& folder) const {
  return reading([&] {
    std::optional<ForeignFile> first;
    for (auto it = fs::recursive_directory_iterator(folder);
         it != fs::recursive_directory_iterator(); ++it) {
      const fs::path name = it->path().lexically_relative(folder);
      if (name == file_name || holds(name, it->path())) continue;
      if (it->is_directory() && !it->is_symlink()) it.disable_recursion_pending();
      if (!first || name < first->path) first = {name, entries_.contains(name.string())};
    }
    return first;
  });
}

bool FileList::remove_from(const fs::path& folder) const {
  std::error_code ignored;
  std::vector<fs::path> folders;
  for (const auto& [name, entry] : entries_) {
    const fs::path path = folder / name;
    if (entry.is_folder) folders.push_back(path);
    try {
      if (!entry.is_folder && holds(name, path)) fs::remove(path, ignored);
    } catch (const std::exception&) {
      continue;  // missing or unreadable: nothing to delete
    }
  }
  fs::remove(folder / file_name, ignored);
  // In order of name, folders follow those that contain them. Folders that are not empty stay.
  std::ranges::reverse(folders);
  for (const fs::path& inner : folders) fs::remove(inner, ignored);
  fs::remove(folder, ignored);
  return !fs::exists(fs::symlink_status(folder, ignored));
}

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/output_folder.hpp"

#include "output/file_list.hpp"

#include <cstdio>
#include <fstream>
#include <optional>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace fs = std::filesystem;
namespace {

/// The absolute path of an output folder, with links followed and without a trailing slash. Throws
/// UsageError if the path is empty, InputError if it is a link to something that does not exist.
fs::path resolved(const fs::path& folder) {
  if (folder.empty()) throw UsageError("the output folder has no name");
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(folder), error);
  if (error) path = fs::absolute(folder).lexically_normal();
  if (!path.has_filename() && path.has_relative_path()) path = path.parent_path();
  if (fs::is_symlink(path, error)) {
    throw InputError(path.string() + ": is a link to " + fs::read_symlink(path, error).string() +
                     ", which does not exist; make that folder, or choose another output folder");
  }
  return path;
}

fs::path sibling(const fs::path& folder, const std::string& suffix) {
  return folder.parent_path() / (folder.filename().string() + suffix + std::to_string(getpid()));
}

/// A sibling path that does not exist yet.
fs::path free_sibling(const fs::path& folder, const std::string& suffix) {
  const fs::path first = sibling(folder, suffix);
  fs::path path = first;
  std::error_code error;
  for (int i = 2; fs::exists(fs::symlink_status(path, error)); ++i) {
    path = first.string() + "-" + std::to_string(i);
  }
  return path;
}

/// Identifies the file or folder at a path, so that a replacement is noticed. Empty if there is
/// nothing.
std::string identity(const fs::path& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return "";
  return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

/// Whether the folder or one inside it is a recording.
bool holds_recording(const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path name = entry.path().filename();
    if (name == "sequence.yaml" || name == "frames.ndjson") return true;
  }
  return false;
}

/// Whether a folder is a mount point, which cannot be renamed.
bool is_mount_point(const fs::path& folder) {
  struct statx status {};
  if (statx(AT_FDCWD, folder.c_str(), 0, STATX_BASIC_STATS, &status) != 0) return false;
  if ((status.stx_attributes_mask & STATX_ATTR_MOUNT_ROOT) != 0) {
    return (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
  }
  struct statx parent {};
  if (statx(AT_FDCWD, folder.parent_path().c_str(), 0, STATX_BASIC_STATS, &parent) != 0) {
    return false;
  }
  return status.stx_dev_major != parent.stx_dev_major ||
         status.stx_dev_minor != parent.stx_dev_minor;
}

/// Throws InputError if a folder, or one inside it, is read-only for its owner.
void refuse_read_only(const fs::path& folder) {
  const auto check = [](const fs::path& path) {
    if ((fs::status(path).permissions() & fs::perms::owner_write) != fs::perms::none) return;
    throw InputError(path.string() +
                     ": is read-only; make it writable, or choose another output folder");
  };
  check(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory() && !entry.is_symlink()) check(entry.path());
  }
}

/// Throws InputError if a folder is not a result, or contains files that tofmap did not write.
void refuse_foreign_files(const fs::path& folder) {
  const std::optional<FileList> list = FileList::read(folder);
  if (!list) {
    throw InputError(folder.string() +
                     ": contains files that are not a result of tofmap, or a result without its "
                     "list of files (" +
                     FileList::file_name + "); choose another output folder, or empty this one");
  }
  const std::optional<ForeignFile> foreign = list->first_foreign(folder);
  if (!foreign) return;
  throw InputError(folder.string() + ": holds " + foreign->path.string() +
                   (foreign->is_changed ? ", which was changed since tofmap wrote it"
                                        : ", which tofmap did not write") +
                   " and which would be lost; move it away, or choose another output folder");
}

void refuse_what_cannot_be_replaced(const fs::path& folder, Replaces replaces) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder.string() + ": is a file; choose another output folder");
  }
  if (is_mount_point(folder)) {
    throw InputError(folder.string() +
                     ": is a mount point, which a result cannot replace; choose another output "
                     "folder, for example " +
                     (folder / "result").string());
  }
  if (fs::is_empty(folder)) {
    refuse_read_only(folder);
    return;
  }
  // A simulated recording has a file list as well, and may be the input of this run.
  const bool may_be_result =
      fs::exists(folder / FileList::file_name) || fs::exists(folder / "options.yaml");
  if (may_be_result && replaces == Replaces::results && holds_recording(folder)) {
    throw InputError(folder.string() +
                     ": is or contains a recording, which the result would replace; choose another "
                     "output folder");
  }
  refuse_foreign_files(folder);
  refuse_read_only(folder);
}

void refuse_foreign(const fs::path& folder, Replaces replaces) {
  try {
    if (fs::exists(folder)) refuse_what_cannot_be_replaced(folder, replaces);
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder.string() + ": cannot be read (" + error.code().message() +
                     "); choose another output folder");
  }
}

bool may_be_replaced(const fs::path& folder, Replaces replaces) {
  try {
    refuse_foreign(folder, replaces);
    return true;
  } catch (const std::exception&) {  // includes folders that cannot be read
    return false;
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, Replaces replaces)
    : folder_(resolved(folder)),
      partial_(free_sibling(folder_, partial_suffix)),
      replaces_(replaces) {
  refuse_foreign(folder_, replaces_);
  earlier_ = identity(folder_);
  std::error_code error;
  fs::create_directories(folder_.parent_path(), error);
  if (!error) fs::create_directory(partial_, error);
  if (error) {
    throw InputError(folder_.string() + ": cannot be created (" + error.message() +
                     "); choose an output folder that is writable");
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!is_committed_) fs::remove_all(partial_, ignored);
}

fs::path OutputFolder::make(const std::string& name) const {
  fs::path path = partial_ / name;
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw InputError(path.string() + ": cannot be created (" + error.message() + ")");
  return path;
}

void OutputFolder::write_text(const std::string& name, const std::string& text) const {
  const fs::path path = partial_ / name;
  std::ofstream out(path);
  out << text;
  out.close();
  if (!out) throw InputError(path.string() + ": cannot be written; is the disk full?");
}

/// Appends a number to the name of the folder if something of that name exists.
void OutputFolder::choose_free_name() {
  const fs::path wanted = folder_;
  for (int i = 2; !identity(folder_).empty(); ++i) {
    folder_ = wanted.parent_path() / (wanted.filename().string() + "-" + std::to_string(i));
  }
}

void OutputFolder::tell_other_name(const fs::path& wanted, Completeness completeness,
                                   bool keeps_earlier) const {
  if (folder_ == wanted) return;
  if (keeps_earlier && completeness == Completeness::taken_back) {
    std::fprintf(stderr, "tofmap: the earlier result in %s is kept, the new one is in %s\n",
                 wanted.c_str(), folder_.c_str());
  } else if (keeps_earlier) {
    std::fprintf(
        stderr,
        "tofmap: interrupted; the earlier result in %s is kept, the new partial result is in %s\n",
        wanted.c_str(), folder_.c_str());
  } else {
    std::fprintf(stderr, "tofmap: %s was created or changed during the run; the result is in %s\n",
                 wanted.c_str(), folder_.c_str());
  }
}

void OutputFolder::commit(Completeness completeness) {
  const fs::path wanted = folder_;
  std::error_code ignored;
  const bool is_lesser =
      completeness == Completeness::interrupted || completeness == Completeness::taken_back;
  const bool keeps_earlier = is_lesser && !earlier_.empty() && !fs::is_empty(folder_, ignored);
  const bool is_taken = identity(folder_) != earlier_ || !may_be_replaced(folder_, replaces_);
  if (keeps_earlier || is_taken) choose_free_name();
  is_committed_ = true;  // from here on the files are kept even if a step fails
  const fs::path replaced = free_sibling(folder_, ".replaced-");
  std::error_code error;
  const bool replaces = fs::exists(folder_, error);
  const std::optional<FileList> earlier = replaces ? FileList::read(folder_) : std::nullopt;
  naming("the result is complete, in " + partial_.string(),
         [&] { FileList::of(partial_).write(partial_ / FileList::file_name); });
  if (replaces) fs::rename(folder_, replaced, error);
  if (!error) fs::rename(partial_, folder_, error);
  if (error == std::errc::directory_not_empty || error == std::errc::file_exists) {
    choose_free_name();  // another run has taken the name in between
    fs::rename(partial_, folder_, error);
  }
  if (error) {
    if (replaces && !fs::exists(folder_, ignored)) fs::rename(replaced, folder_, ignored);
    throw InputError(folder_.string() + ": the result cannot be moved there (" + error.message() +
                     "); it is in " + partial_.string());
  }
  if (replaces && !earlier.value_or(FileList()).remove_from(replaced)) {
    std::fprintf(stderr,
                 "tofmap: %s contained files that tofmap did not write; they are now in %s\n",
                 folder_.c_str(), replaced.c_str());
  }
  tell_other_name(wanted, completeness, keeps_earlier);
}

void OutputFolder::keep() { is_committed_ = true; }

}  // namespace tofmap::app

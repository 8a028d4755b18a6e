// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/output_folder.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace fs = std::filesystem;
namespace {

/// "results/" and "results" are one folder, "." is where we stand.
fs::path normalised(const fs::path& folder) {
  if (folder.empty()) throw UsageError("the output folder has no name");
  fs::path path = fs::absolute(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  return path;
}

fs::path sibling(const fs::path& folder, const std::string& suffix) {
  return folder.parent_path() / (folder.filename().string() + suffix + std::to_string(getpid()));
}

/// Tells what is at a path from what was there before or comes later; empty if there is nothing.
std::string identity(const fs::path& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return "";
  return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

/// Whether a recording lies in the folder or below.
bool holds_recording(const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().filename() == "sequence.yaml") return true;
  }
  return false;
}

/// Everything that a command puts into a result folder, or a simulated recording.
constexpr std::array result_names{
    "amplitude_a",     "amplitude_b",   "confidence",    "frames.txt",  "groundtruth.txt",
    "joint",           "jump",          "keyframes.txt", "label_truth", "map.pcd",
    "map.ply",         "merged.ply",    "mesh.ply",      "none",        "options.yaml",
    "paper",           "phase_a",       "phase_b",       "pictures",    "pixel",
    "range",           "range_truth",   "reason",        "report.html", "report.json",
    "scene.ply",       "sequence.yaml", "single",        "state.bin",   "trajectory.txt",
    "transforms.json", "wraps"};

/// The first thing in a folder that no command puts there; empty if there is none.
std::string foreign_name(const fs::path& folder) {
  std::vector<std::string> foreign;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("pictures.partial-")) continue;  // of a run that was killed
    if (std::ranges::find(result_names, name) == result_names.end()) foreign.push_back(name);
  }
  return foreign.empty() ? "" : *std::ranges::min_element(foreign);
}

void refuse_foreign(const fs::path& folder, Replaces replaces) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) {
    throw InputError(folder.string() + ": is a file; choose another output folder");
  }
  if (!fs::is_empty(folder) && !fs::exists(folder / "options.yaml")) {
    throw InputError(folder.string() +
                     ": holds files that are no result of tofmap; choose another output folder, "
                     "or empty it");
  }
  // A simulated recording has an options.yaml as well, and may be what the result is made from.
  if (replaces == Replaces::results && holds_recording(folder)) {
    throw InputError(folder.string() +
                     ": is or holds a recording, which the result would replace; choose another "
                     "output folder");
  }
  const std::string foreign = foreign_name(folder);
  if (!foreign.empty()) {
    throw InputError(folder.string() + ": holds " + foreign +
                     ", which no result of tofmap has and which would be lost; move it away, or "
                     "choose another output folder");
  }
}

bool may_be_replaced(const fs::path& folder, Replaces replaces) {
  try {
    refuse_foreign(folder, replaces);
    return true;
  } catch (const std::exception&) {  // what cannot be read is of others as well
    return false;
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, Replaces replaces)
    : folder_(normalised(folder)), partial_(sibling(folder_, ".partial-")), replaces_(replaces) {
  std::error_code error;
  if (fs::exists(folder_, error)) refuse_foreign(folder_, replaces_);
  earlier_ = identity(folder_);
  fs::create_directories(folder_.parent_path(), error);
  if (!error) {
    fs::remove_all(partial_, error);
    fs::create_directory(partial_, error);
  }
  if (error) {
    throw InputError(folder_.string() + ": cannot be made (" + error.message() +
                     "); choose an output folder that can be written");
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
  if (error) throw InputError(path.string() + ": cannot be made (" + error.message() + ")");
  return path;
}

void OutputFolder::write_text(const std::string& name, const std::string& text) const {
  const fs::path path = partial_ / name;
  std::ofstream out(path);
  out << text;
  out.close();
  if (!out) throw InputError(path.string() + ": cannot be written; is the disk full?");
}

/// Chooses another name if that of the folder was taken meanwhile, by another run for example.
void OutputFolder::make_way() {
  if (identity(folder_) == earlier_ && may_be_replaced(folder_, replaces_)) return;
  const fs::path wanted = folder_;
  for (int i = 2; !identity(folder_).empty(); ++i) {
    folder_ = wanted.parent_path() / (wanted.filename().string() + "-" + std::to_string(i));
  }
}

void OutputFolder::commit() {
  const fs::path wanted = folder_;
  make_way();
  const fs::path replaced = sibling(folder_, ".replaced-");
  std::error_code error;
  const bool replaces = fs::exists(folder_, error);
  if (replaces) fs::rename(folder_, replaced, error);
  if (!error) fs::rename(partial_, folder_, error);
  is_committed_ = true;  // what was made is kept at any rate
  if (error) {
    std::error_code ignored;
    if (replaces && !fs::exists(folder_, ignored)) fs::rename(replaced, folder_, ignored);
    throw InputError(folder_.string() + ": the result cannot be moved there (" + error.message() +
                     "); it is in " + partial_.string());
  }
  if (replaces) fs::remove_all(replaced, error);
  if (folder_ == wanted) return;
  std::fprintf(stderr, "tofmap: something else came to %s meanwhile; the result is in %s\n",
               wanted.c_str(), folder_.c_str());
}

}  // namespace tofmap::app

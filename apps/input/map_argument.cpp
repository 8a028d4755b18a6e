// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/map_argument.hpp"

#include <string>

#include <tofmap/core/error.hpp>
#include <tofmap/mapping/map_store.hpp>

namespace tofmap::app {

std::filesystem::path map_file_in(const std::filesystem::path& argument) {
  std::error_code error;
  if (!std::filesystem::exists(argument, error)) {
    throw InputError(argument.string() + ": does not exist; give a folder that 'tofmap map' wrote");
  }
  if (!std::filesystem::is_directory(argument, error)) return argument;
  std::filesystem::path file = argument / map_file_name;
  if (!std::filesystem::exists(file, error)) {
    throw InputError(argument.string() + ": holds no " + map_file_name +
                     "; give a folder that 'tofmap map' wrote");
  }
  return file;
}

void refuse_to_replace(const std::filesystem::path& map_file, const std::filesystem::path& out) {
  std::error_code error;
  const auto folder = std::filesystem::canonical(map_file, error).parent_path();
  if (error || folder != std::filesystem::weakly_canonical(out, error)) return;
  throw UsageError(map_file.string() +
                   ": is in the folder of the result, which would replace it; "
                   "give another --out");
}

void refuse_to_replace_grown_map(const std::filesystem::path& out) {
  const std::filesystem::path file = out / map_file_name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return;
  std::size_t recordings = 0;
  try {
    recordings = MapStore::open(file).content().recordings.size();
  } catch (const InputError&) {
    return;  // nothing that could be used is lost
  }
  if (recordings <= 1) return;
  throw UsageError(file.string() + ": is a map of " + std::to_string(recordings) +
                   " recordings, which the result would replace; give another --out, or remove it "
                   "if it is not needed");
}

bool is_map(const std::filesystem::path& argument) {
  std::error_code error;
  if (!std::filesystem::is_directory(argument, error)) return argument.extension() == ".db";
  return std::filesystem::exists(argument / map_file_name, error) &&
         !std::filesystem::exists(argument / "sequence.yaml", error);
}

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/result_addition.hpp"

#include "command.hpp"
#include "console/failure.hpp"
#include "output/file_list.hpp"

#include <cstdio>

#include <unistd.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace fs = std::filesystem;
namespace {

/// A path beside a result that does not exist yet.
fs::path beside(const fs::path& result, const std::string& name) {
  const std::string first =
      result.filename().string() + "." + name + ".partial-" + std::to_string(getpid());
  fs::path path = result.parent_path() / first;
  std::error_code error;
  for (int i = 2; fs::exists(fs::symlink_status(path, error)); ++i) {
    path = result.parent_path() / (first + "-" + std::to_string(i));
  }
  return path;
}

void rename_or_throw(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw InputError(to.string() + ": cannot be moved there (" + error.message() + ")");
}

}  // namespace

ResultAddition::ResultAddition(const fs::path& result, const std::string& name)
    : result_(result), name_(name), partial_(beside(result, name)) {}

ResultAddition::~ResultAddition() {
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
}

void ResultAddition::commit() {
  // The list is written first, so that the result can still be replaced if the run is killed
  // between the two steps.
  FileList list = FileList::read(result_).value_or(FileList());
  list.add(FileList::of(partial_, name_));
  ResultAddition list_file(result_, "files");
  list.write(list_file.path());
  rename_or_throw(list_file.path(), result_ / FileList::file_name);
  rename_or_throw(partial_, result_ / name_);
}

int add_to_result(const fs::path& result, int status, const std::vector<OptionalPart>& parts) {
  if (status == exit_status::interrupted) count_interruptions_anew();
  Failures failures;
  std::vector<std::string> missing;
  for (const OptionalPart& part : parts) missing.push_back(part.name);
  try {
    for (const OptionalPart& part : parts) {
      failures.attempt(part.name, part.add);
      missing.erase(missing.begin());
    }
  } catch (const Interrupted&) {
    std::fprintf(stderr, "tofmap: interrupted; %s is complete, but without %s\n", result.c_str(),
                 joined(missing, " or ").c_str());
    return exit_status::interrupted;
  }
  for (const std::string& text : failures.texts()) {
    std::fprintf(stderr, "tofmap: %s is complete, but without %s\n", result.c_str(), text.c_str());
  }
  return failures.status_or(status);
}

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tofmap::app {

/// A folder or file that comes to a result which is in place already, as pictures and the page do.
/// It is written beside the result and appears in it when it is whole. Without commit nothing is
/// left, and the result is as it was.
class ResultAddition {
 public:
  ResultAddition(const std::filesystem::path& result, const std::string& name);
  ResultAddition(const ResultAddition&) = delete;
  ResultAddition& operator=(const ResultAddition&) = delete;
  ~ResultAddition();

  /// Where to make the folder or write the file until commit; nothing is there yet.
  const std::filesystem::path& path() const { return partial_; }

  /// Moves it into the result, whose list of files names it then. Throws InputError if it cannot.
  void commit();

 private:
  std::filesystem::path result_;
  std::string name_;
  std::filesystem::path partial_;
};

/// A part of a result that it can do without, as pictures and a page are.
struct OptionalPart {
  std::string name;
  std::function<void()> add;
};

/// Adds parts to a result that is in place. One that fails is named on stderr, with the reason and
/// that the result is whole without it, and the others are added all the same. Returns the status
/// of the command, which was `status` so far: that of the first failure, and interrupted if the
/// user ends this, which is said. A run that was interrupted before is at an end here, so that a
/// further Ctrl-C counts anew.
int add_to_result(const std::filesystem::path& result, int status,
                  const std::vector<OptionalPart>& parts);

}  // namespace tofmap::app

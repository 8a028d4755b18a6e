// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tofmap::app {

/// A folder or file that is added to a result that is already in place, such as the pictures and
/// the page. It is written beside the result, and `commit` moves it into the result. Without commit
/// it is deleted, and the result stays as it was.
class ResultAddition {
 public:
  /// `result` is the folder of the result, `name` that of the addition inside it.
  ResultAddition(const std::filesystem::path& result, const std::string& name);
  ResultAddition(const ResultAddition&) = delete;
  ResultAddition& operator=(const ResultAddition&) = delete;
  ~ResultAddition();

  /// The temporary path of the folder or file, to be created before commit.
  const std::filesystem::path& path() const { return partial_; }

  /// Moves the addition into the result and adds it to the result's file list. Throws InputError if
  /// that fails.
  void commit();

 private:
  std::filesystem::path result_;
  std::string name_;
  std::filesystem::path partial_;
};

/// A part that a result is useful without, such as pictures and the page.
struct OptionalPart {
  std::string name;           ///< as used in messages
  std::function<void()> add;  ///< writes the part into the result
};

/// Adds parts to a result that is in place. If a part fails, a message on stderr names it with the
/// reason, and the other parts are added all the same. Returns the exit status of the command:
/// `interrupted` if the user interrupts this, else the status of the first failure, else `status`.
/// If `status` is `interrupted`, an earlier Ctrl-C is cleared, so that only another one interrupts
/// this.
int add_to_result(const std::filesystem::path& result, int status,
                  const std::vector<OptionalPart>& parts);

}  // namespace tofmap::app

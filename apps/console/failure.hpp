// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "console/interruption.hpp"

#include <exception>
#include <string>
#include <vector>

namespace tofmap::app {

/// What became of an exception: the exit status that it stands for, and what is said about it.
struct Failure {
  int status = 0;
  std::string message;
};

/// The failure of an exception that is not Interrupted.
Failure failure_of(const std::exception_ptr& error);

/// The failures of parts of a run that the other parts do not need: each is noted, and the run goes
/// on.
class Failures {
 public:
  /// Does a part of the run, called `what`. Returns whether it could be done. Interrupted passes.
  template <class Part>
  bool attempt(const std::string& what, const Part& part) {
    try {
      part();
      return true;
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      add(what, std::current_exception());
      return false;
    }
  }

  bool empty() const { return failed_.empty(); }

  /// Names of the parts that failed, with the reason: "mesh.ply: out of memory".
  std::vector<std::string> texts() const;

  /// The exit status of the first failure; `status` if there is none.
  int status_or(int status) const;

  /// Throws the first failure as it came.
  [[noreturn]] void rethrow_first() const;

 private:
  struct Failed {
    std::string what;
    std::exception_ptr error;
  };

  void add(const std::string& what, std::exception_ptr error);

  std::vector<Failed> failed_;
};

}  // namespace tofmap::app

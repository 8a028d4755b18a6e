// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "console/interruption.hpp"

#include <exception>
#include <string>
#include <vector>

namespace tofmap::app {

/// An exception as the program reports it: exit status and message.
struct Failure {
  int status = 0;
  std::string message;
};

/// The exit status and message for an exception, which must not be Interrupted.
Failure failure_of(const std::exception_ptr& error);

/// Collects the failures of optional parts of a run, such as a mesh or pictures. The run continues
/// without them.
class Failures {
 public:
  /// Calls `part` and returns whether it succeeded. An exception is stored under the name `what`;
  /// only Interrupted is passed on.
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

  /// The names of the parts that failed, each with the reason: "mesh.ply: out of memory".
  std::vector<std::string> texts() const;

  /// The exit status of the first failure, or `status` if nothing failed.
  int status_or(int status) const;

  /// Throws the exception of the first failure again. There must be one.
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

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace tofmap {

/// Wrong usage: an argument or option that is not allowed. The message names the argument, the
/// given value and the allowed values. The program exits with status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Missing, damaged or contradictory input, or a file or folder that cannot be written. The message
/// names the file and the remedy. The program exits with status 3.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs `step` and returns its result. If the step throws an InputError, rethrows it with `origin`
/// and a colon before the message.
template <class Step>
auto naming(const std::string& origin, const Step& step) {
  try {
    return step();
  } catch (const InputError& error) {
    throw InputError(origin + ": " + error.what());
  }
}

}  // namespace tofmap

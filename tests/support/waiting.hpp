// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <thread>

namespace tofmap::test {

/// Waits until a condition holds; false if it does not within four minutes, which is ample even
/// under sanitizers on a busy machine.
template <class Condition>
bool comes_true(const Condition& holds) {
  using namespace std::chrono_literals;
  for (const auto start = std::chrono::steady_clock::now(); !holds();) {
    if (std::chrono::steady_clock::now() - start > 240s) return false;
    std::this_thread::sleep_for(2ms);
  }
  return true;
}

}  // namespace tofmap::test

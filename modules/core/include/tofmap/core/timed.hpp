// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace tofmap {

/// Runs `step`, adds its wall-clock duration in milliseconds to `spent_ms`, and returns the result
/// of the step. Adds the duration even if the step throws.
template <class Step>
auto timed(double& spent_ms, const Step& step) {
  struct Timer {
    double& spent_ms;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Timer() {
      const auto end = std::chrono::steady_clock::now();
      spent_ms += std::chrono::duration<double, std::milli>(end - start).count();
    }
  };
  const Timer timer{spent_ms};
  return step();
}

}  // namespace tofmap

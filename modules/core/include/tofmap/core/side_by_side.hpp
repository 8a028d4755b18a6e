// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <vector>

#include <omp.h>

namespace tofmap {

/// Runs step(0) … step(count − 1) in parallel on all OpenMP threads and returns their results in
/// order. If steps throw, rethrows the exception of the lowest number after all steps have ended.
template <class Step>
auto side_by_side(int count, const Step& step) {
  using Result = decltype(step(0));
  std::vector<Result> results(static_cast<std::size_t>(count));
  std::vector<std::exception_ptr> errors(results.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < count; ++i) {
    try {
      results[i] = step(i);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return results;
}

/// Copies of `worker`, one for each OpenMP thread.
template <class Worker>
std::vector<Worker> one_a_thread(const Worker& worker) {
  return std::vector<Worker>(static_cast<std::size_t>(omp_get_max_threads()), worker);
}

/// Runs step(worker, i) for i = 0 … count − 1 in parallel. No two threads share a worker, so a
/// worker can keep buffers between steps. `workers` comes from one_a_thread().
template <class Worker, class Step>
auto side_by_side(int count, std::vector<Worker>& workers, const Step& step) {
  return side_by_side(count, [&](int i) {
    return step(workers[static_cast<std::size_t>(omp_get_thread_num())], i);
  });
}

}  // namespace tofmap

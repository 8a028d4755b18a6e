// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <vector>

#include <omp.h>

namespace tofmap {

/// The results of step(0) … step(count − 1) in their order, computed by as many threads as
/// OpenMP has. If steps throw, the first of them, by number, is rethrown once all have ended.
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

/// A copy of the worker for each thread that OpenMP has.
template <class Worker>
std::vector<Worker> one_a_thread(const Worker& worker) {
  return std::vector<Worker>(static_cast<std::size_t>(omp_get_max_threads()), worker);
}

/// side_by_side with workers that keep buffers between steps: step(worker, i), where no two threads
/// share a worker. `workers` is of `one_a_thread`.
template <class Worker, class Step>
auto side_by_side(int count, std::vector<Worker>& workers, const Step& step) {
  return side_by_side(count, [&](int i) {
    return step(workers[static_cast<std::size_t>(omp_get_thread_num())], i);
  });
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "console/failure.hpp"

#include "command.hpp"

#include <filesystem>
#include <new>

#include <tofmap/core/error.hpp>
#include <tofmap/visualization/drawing.hpp>

namespace tofmap::app {

Failure failure_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const UsageError& usage) {
    return {exit_status::bad_use, usage.what()};
  } catch (const InputError& input) {
    return {exit_status::bad_input, input.what()};
  } catch (const DrawingError& drawing) {
    return {exit_status::own_fault, drawing.what()};
  } catch (const std::filesystem::filesystem_error& files) {
    return {exit_status::bad_input, files.path1().string() + ": " + files.code().message()};
  } catch (const std::bad_alloc&) {
    return {exit_status::own_fault, "out of memory"};
  } catch (const std::exception& other) {
    return {exit_status::own_fault, std::string("internal error: ") + other.what()};
  }
}

void Failures::add(const std::string& what, std::exception_ptr error) {
  failed_.push_back({what, std::move(error)});
}

std::vector<std::string> Failures::texts() const {
  std::vector<std::string> texts;
  for (const Failed& one : failed_)
    texts.push_back(one.what + ": " + failure_of(one.error).message);
  return texts;
}

int Failures::status_or(int status) const {
  return failed_.empty() ? status : failure_of(failed_.front().error).status;
}

void Failures::rethrow_first() const { std::rethrow_exception(failed_.front().error); }

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "console/failure.hpp"

#include "command.hpp"

#include <filesystem>
#include <new>

#include <gmock/gmock.h>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace {

using testing::ElementsAre;

template <class Error>
Failure failure(const Error& error) {
  return failure_of(std::make_exception_ptr(error));
}

TEST(Failure, HasTheStatusOfItsKind) {
  EXPECT_EQ(failure(UsageError("x")).status, exit_status::bad_use);
  EXPECT_EQ(failure(InputError("x")).status, exit_status::bad_input);
  EXPECT_EQ(failure(std::runtime_error("x")).status, exit_status::own_fault);
  EXPECT_EQ(failure(std::bad_alloc()).message, "out of memory");
  const std::filesystem::filesystem_error denied(
      "exists", "seq", std::make_error_code(std::errc::permission_denied));
  EXPECT_EQ(failure(denied).status, exit_status::bad_input);
  EXPECT_EQ(failure(denied).message, "seq: Permission denied");
}

TEST(Failures, AreNotedAndTheOtherPartsAreDone) {
  Failures failures;
  int done = 0;
  EXPECT_TRUE(failures.attempt("none", [&] { ++done; }));
  EXPECT_EQ(failures.status_or(exit_status::done), exit_status::done);
  EXPECT_FALSE(failures.attempt("jump", [] { throw std::bad_alloc(); }));
  EXPECT_FALSE(failures.attempt("pixel", [] { throw InputError("no frame"); }));
  EXPECT_TRUE(failures.attempt("joint", [&] { ++done; }));
  EXPECT_EQ(done, 2);
  EXPECT_THAT(failures.texts(), ElementsAre("jump: out of memory", "pixel: no frame"));
  EXPECT_EQ(failures.status_or(exit_status::done), exit_status::own_fault);
  EXPECT_THROW(failures.rethrow_first(), std::bad_alloc);
}

TEST(Failures, LetInterruptionsPass) {
  Failures failures;
  EXPECT_THROW(failures.attempt("jump", [] { throw Interrupted(); }), Interrupted);
  EXPECT_TRUE(failures.empty());
}

}  // namespace
}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/result_addition.hpp"

#include "command.hpp"
#include "console/interruption.hpp"
#include "output/file_list.hpp"

#include <fstream>
#include <new>

#include <gmock/gmock.h>
#include <support/temporary_folder.hpp>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class Result : public testing::Test {
 protected:
  Result() { fs::create_directory(result_); }

  /// Adds a page, and before it pictures that fail in some way.
  template <class Fail>
  int add(int status, const Fail& fail) const {
    return add_to_result(result_, status,
                         {{"pictures", fail}, {"report.html", [&] { add_page(); }}});
  }

  void add_page() const {
    ResultAddition page(result_, "report.html");
    std::ofstream(page.path()) << "page";
    page.commit();
  }

  test::TemporaryFolder parent_;
  fs::path result_ = parent_.path() / "result";
};

TEST_F(Result, GetsThePartsThatDoNotFail) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(add(exit_status::done, [] { throw std::bad_alloc(); }), exit_status::own_fault);
  EXPECT_THAT(
      testing::internal::GetCapturedStderr(),
      AllOf(HasSubstr(result_.string() + " is complete, but without pictures: out of memory")));
  EXPECT_TRUE(fs::exists(result_ / "report.html"));
  EXPECT_FALSE(FileList::read(result_)->first_foreign(result_));
}

TEST_F(Result, TellsBadInputByItsStatus) {
  EXPECT_EQ(add(exit_status::done, [] { throw InputError("full"); }), exit_status::bad_input);
  EXPECT_EQ(add(exit_status::done, [] {}), exit_status::done);
}

TEST_F(Result, GetsNothingMoreOnceTheUserWantsToStop) {
  EXPECT_EQ(add(exit_status::done, [] { throw Interrupted(); }), exit_status::interrupted);
  EXPECT_FALSE(fs::exists(result_ / "report.html"));
}

TEST_F(Result, IsAsItWasWithoutCommit) {
  {
    ResultAddition pictures(result_, "pictures");
    fs::create_directory(pictures.path());
    std::ofstream(pictures.path() / "a.png") << "x";
  }
  EXPECT_TRUE(fs::is_empty(result_));
  EXPECT_EQ(std::distance(fs::directory_iterator(parent_.path()), {}), 1);
}

}  // namespace
}  // namespace tofmap::app

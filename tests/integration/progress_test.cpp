// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <cstdio>
#include <cstdlib>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

namespace tofmap::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Records for four seconds, which is long enough to be told.
class Progress : public testing::Test {
 protected:
  std::vector<std::string> arguments() const {
    return {"record", uri_, "--frames", "16", "--out", (folder_.path() / "out").string()};
  }

  /// What the program says on a terminal.
  std::string on_terminal() const {
    std::string command = TOFMAP_PROGRAM;
    for (const std::string& word : arguments()) command += " '" + word + "'";
    const std::string inside_script = "script -qec \"" + command + "\" /dev/null < /dev/null";
    FILE* pipe = popen(inside_script.c_str(), "r");
    std::string said;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
      said += static_cast<char>(c);
    }
    pclose(pipe);
    return said;
  }

  TemporaryFolder folder_;
  std::string uri_ =
      "tofmap://room?simulator.width_px=64&simulator.height_px=48&simulator.subpixels=1"
      "&simulator.frame_rate_hz=4";
};

TEST_F(Progress, IsALineNowAndThenWithoutATerminal) {
  const Finished finished = run_program(arguments());
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.err,
              ContainsRegex("^recording frame [0-9]+ of 16, [0-9.]+ a second, [0-9]+ s left\n"));
  EXPECT_THAT(finished.err, Not(HasSubstr("\r")));
}

TEST_F(Progress, IsABarOnATerminal) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0) GTEST_SKIP() << "no pseudo-terminals here (is /dev/pts mounted?)";
  close(terminal);
  EXPECT_THAT(on_terminal(), ContainsRegex("\rrecording frame \\[#+\\.+\\] [0-9]+ of 16, "));
}

TEST_F(Progress, IsNoneIfItIsToBeQuiet) {
  std::vector<std::string> quiet = arguments();
  quiet.emplace_back("--quiet");
  EXPECT_THAT(run_program(quiet).err, IsEmpty());
}

}  // namespace
}  // namespace tofmap::test

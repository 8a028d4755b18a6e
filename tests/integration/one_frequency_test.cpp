// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Recordings of cameras with a single modulation frequency, whose wrap counts are relative.

#include "program.hpp"

#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class OneFrequencyRecording : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    simulated_ =
        run_program({"simulate", "room", "--frames", "4", "--out", recording().string(), "--set",
                     "simulator.frequencies_hz=[15e6]", "--set", "simulator.width_px=88", "--set",
                     "simulator.height_px=72", "--set", "simulator.subpixels=1"});
  }
  static void TearDownTestSuite() { made_.reset(); }

  void SetUp() override { ASSERT_EQ(simulated_.status, 0) << simulated_.err; }

  static fs::path recording() { return made_->path() / "recording"; }

  /// Runs a command with the recording and a result folder of its own.
  Finished run(const std::string& command, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{command, recording().string(), "--out", out_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }

  static std::unique_ptr<TemporaryFolder> made_;
  static Finished simulated_;
  TemporaryFolder folder_;
  fs::path out_ = folder_.path() / "out";
};

std::unique_ptr<TemporaryFolder> OneFrequencyRecording::made_;
Finished OneFrequencyRecording::simulated_;

TEST_F(OneFrequencyRecording, IsNotMappedByMethodsThatFindWrapCounts) {
  for (const char* method : {"joint", "pixel", "single"}) {
    const Finished finished = run("map", {"--method", method});
    EXPECT_EQ(finished.status, 2) << method;
    EXPECT_THAT(finished.err, HasSubstr("set unwrap.max_range_m=9.99")) << method;
    EXPECT_FALSE(fs::exists(out_)) << method;
  }
}

TEST_F(OneFrequencyRecording, IsUnwrappedWithAWarning) {
  const Finished finished = run("unwrap", {"--set", "pictures.frames=0"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("warning: one frequency cannot tell wrap counts apart"));
}

TEST_F(OneFrequencyRecording, WithinItsWavelengthIsMappedWithoutThatWarning) {
  const Finished finished = run("map", {"--set", "unwrap.max_range_m=9.99"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, Not(HasSubstr("cannot tell wrap counts apart")));
}

TEST_F(OneFrequencyRecording, IsEvaluatedByTheMethodsThatItAllows) {
  const Finished finished =
      run("evaluate", {"--set", "evaluation.down_to=unwrapping", "--set", "pictures.frames=0"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("warning: paper was skipped"),
                                  HasSubstr("warning: jump was skipped"), HasSubstr("joint")));
  EXPECT_EQ(read_json(out_ / "report.json")["skipped"].size(), 2U);
}

TEST_F(OneFrequencyRecording, IsNotEvaluatedByAMethodThatComparesTwoAlone) {
  const Finished finished = run("evaluate", {"--set", "evaluation.methods=jump"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("jump compares two frequencies"));
}

}  // namespace
}  // namespace tofmap::test

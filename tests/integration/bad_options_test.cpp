// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <fstream>

#include <gmock/gmock.h>

namespace tofmap::test {
namespace {

using testing::HasSubstr;

class BadOptions : public WithRecording {
 protected:
  /// Expects status 2, a message that holds all parts, and no result.
  void expect_bad_use(const std::vector<std::string>& more,
                      const std::vector<std::string>& parts) const {
    for (const std::string command : {"unwrap", "map"}) {
      const Finished finished = run(command, more);
      EXPECT_EQ(finished.status, 2) << command;
      for (const std::string& part : parts) EXPECT_THAT(finished.err, HasSubstr(part)) << command;
      EXPECT_EQ(finished.out, "") << command;
      EXPECT_EQ(names_in(folder_.path()).back(), "seq") << command;
    }
  }

  std::string config(const std::string& text) const {
    std::ofstream(folder_.path() / "options.yaml") << text;
    return (folder_.path() / "options.yaml").string();
  }
};

TEST_F(BadOptions, UnknownKeyIsNamedWithItsNeighbours) {
  expect_bad_use({"--set", "unwrap.max_rnge_m=30"},
                 {"unwrap.max_rnge_m", "'30'", "unwrap.max_range_m"});
}

TEST_F(BadOptions, UnknownKeyInAFileIsNamedWithFileAndLine) {
  expect_bad_use({"--config", config("unwrap:\n  max_rnge_m: 30\n")},
                 {"options.yaml:2", "unwrap.max_rnge_m"});
}

TEST_F(BadOptions, ValueOutOfRangeTellsWhatIsAllowed) {
  expect_bad_use({"--set", "filters.min_confidence=1.5"},
                 {"filters.min_confidence", "'1.5'", "0 … 1"});
}

TEST_F(BadOptions, FurnitureIsRearrangedWithinLimits) {
  const auto simulate = [&](const std::string& option) {
    return run_program({"simulate", "wall", "--out", out_.string(), "--set", option});
  };
  const Finished many = simulate("simulator.rearranged=51");
  EXPECT_EQ(many.status, 2);
  EXPECT_THAT(many.err, HasSubstr("simulator.rearranged"));
  EXPECT_THAT(many.err, HasSubstr("0 … 50"));
  EXPECT_EQ(simulate("simulator.walk=-1").status, 2);
  EXPECT_EQ(simulate("simulator.arrangement=-1").status, 2);
}

TEST_F(BadOptions, ValueThatIsNoNumberIsRefused) {
  expect_bad_use({"--set", "unwrap.max_range_m=nan"}, {"unwrap.max_range_m", "'nan'"});
  expect_bad_use({"--set", "unwrap.max_range_m=30m"}, {"unwrap.max_range_m", "'30m'"});
}

TEST_F(BadOptions, UnknownMethodTellsWhichThereAre) {
  expect_bad_use({"--method", "magic"}, {"'magic'", "jump", "paper", "single", "pixel", "none"});
}

TEST_F(BadOptions, AssignmentWithoutValueIsRefused) {
  expect_bad_use({"--set", "unwrap.max_range_m"}, {"group.name=value"});
}

TEST(BadCommand, IsNamed) {
  const Finished finished = run_program({"foo", "--out", "bar"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("no command 'foo'"));
}

TEST_F(BadOptions, UnknownArgumentIsRefused) {
  expect_bad_use({"--fast"}, {"tofmap: ", "--fast", " --help' lists what can be given"});
}

TEST_F(BadOptions, OptionOfAnotherCommandIsRefusedWithItsName) {
  expect_bad_use({"--set", "simulator.people=1"},
                 {"simulator.people=1", "has no group simulator; it belongs to simulate"});
}

TEST_F(BadOptions, NumberOfThreadsIsChecked) { expect_bad_use({"--threads", "-1"}, {"--threads"}); }

TEST_F(BadOptions, SeedAndFramesOfASimulationAreChecked) {
  for (const std::string argument : {"--seed", "--frames"}) {
    const Finished finished =
        run_program({"simulate", "room", "--out", out_.string(), argument, "-1"});
    EXPECT_EQ(finished.status, 2) << argument;
    EXPECT_THAT(finished.err, HasSubstr("'-1' is not allowed; allowed: whole number, 0 …"));
  }
}

TEST_F(BadOptions, ConfigurationThatIsMissingIsBadInput) {
  const Finished finished = run("map", {"--config", "/no/such/file.yaml"});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("/no/such/file.yaml"));
}

TEST_F(BadOptions, ConfigurationThatIsAFolderIsBadInput) {
  for (const std::string option : {"--config", "--calibration"}) {
    const Finished finished = run("map", {option, folder_.path().string()});
    EXPECT_EQ(finished.status, 3) << option;
    EXPECT_THAT(finished.err, HasSubstr(folder_.path().string() + ": is a folder")) << option;
  }
}

TEST_F(BadOptions, ConfigurationThatIsNoYamlIsBadInput) {
  const Finished finished = run("map", {"--config", config("unwrap: [1, 2\n")});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("is not valid YAML"));
}

TEST(Program, NeedsACommand) {
  const Finished finished = run_program({});
  EXPECT_EQ(finished.status, 2);
  EXPECT_NE(finished.err, "");
}

TEST(Program, RefusesAnUnknownCommand) { EXPECT_EQ(run_program({"mapp"}).status, 2); }

TEST(Program, NeedsAnOutputFolder) {
  const Finished finished = run_program({"map", "somewhere"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("--out"));
}

TEST(Program, RefusesAnUnknownScene) {
  const TemporaryFolder folder;
  const Finished finished =
      run_program({"simulate", "castle", "--out", (folder.path() / "seq").string()});
  EXPECT_NE(finished.status, 0);
  EXPECT_THAT(finished.err, HasSubstr("castle"));
  EXPECT_THAT(finished.err, HasSubstr("corridor")) << "the scenes there are";
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(Program, RefusesConfigurationOfACommandThatIsNone) {
  EXPECT_EQ(run_program({"config", "mapp"}).status, 2);
}

}  // namespace
}  // namespace tofmap::test

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/core/named_value.hpp>
#include <tofmap/core/option_table.hpp>

namespace tofmap {
namespace {

enum class Pace { steady, brisk };

std::span<const NamedValue<Pace>> named_values(Pace) {
  static constexpr std::array<NamedValue<Pace>, 2> paces{
      {{"brisk", Pace::brisk}, {"steady", Pace::steady}}};
  return paces;
}

struct StageOptions {
  bool enabled = true;
  int count = 5;
  double reach_m = 0.1;
  double anything = -2;
  std::string note;
  Pace pace = Pace::brisk;
  std::vector<Pace> legs = {Pace::steady};
  std::vector<double> stops_m = {1, 2.5};

  static std::vector<OptionField<StageOptions>> fields() {
    using O = StageOptions;
    return {{"enabled", &O::enabled, 0, 0, "", "whether it runs"},
            {"count", &O::count, 1, 10, "", "how often"},
            {"reach_m", &O::reach_m, 0, 20, "m", "how far"},
            {.name = "anything", .member = &O::anything, .unit = "", .meaning = "a number"},
            {"note", &O::note, 0, 0, "", "free text"},
            {"pace", &O::pace, 0, 0, "", "how fast"},
            {"legs", &O::legs, 0, 0, "", "how fast, one after the other"},
            {"stops_m", &O::stops_m, 0, 10, "m", "where it rests"}};
  }
};

struct TopOptions {
  int threads = 0;

  static std::vector<OptionField<TopOptions>> fields() {
    return {{"threads", &TopOptions::threads, 0, 64, "", "threads to use"}};
  }
};

class Options : public testing::Test {
 protected:
  Options() {
    table_.bind("", top_);
    table_.bind("stage", stage_);
  }

  std::filesystem::path file(const std::string& text) const {
    const std::filesystem::path path = folder_.path() / "options.yaml";
    std::ofstream(path) << text;
    return path;
  }

  /// Expects that `action` throws an Error whose message holds all parts.
  template <class Error, class Action>
  void expect_refusal(const Action& action, const std::vector<std::string>& parts) const {
    try {
      action();
      ADD_FAILURE() << "accepted; expected a complaint about " << parts.front();
    } catch (const Error& error) {
      for (const std::string& part : parts) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
            << "'" << part << "' is not in: " << error.what();
      }
    }
  }

  void expect_unset(const std::string& key, const std::string& value,
                    const std::vector<std::string>& parts) {
    const std::string before = table_.to_yaml(false);
    expect_refusal<UsageError>([&] { table_.set(key, value); }, parts);
    EXPECT_EQ(table_.to_yaml(false), before) << "a refused value must change nothing";
  }

  test::TemporaryFolder folder_;
  TopOptions top_;
  StageOptions stage_;
  OptionTable table_;
};

TEST_F(Options, AreSetFromTextByTheirKey) {
  table_.set("stage.enabled", "false");
  table_.set("stage.count", "7");
  table_.set("stage.reach_m", "1.25e1");
  table_.set("stage.pace", "steady");
  table_.set("stage.note", "two words");
  table_.set("threads", "3");
  EXPECT_FALSE(stage_.enabled);
  EXPECT_EQ(stage_.count, 7);
  EXPECT_EQ(stage_.reach_m, 12.5);
  EXPECT_EQ(stage_.pace, Pace::steady);
  EXPECT_EQ(stage_.note, "two words");
  EXPECT_EQ(top_.threads, 3);
}

TEST_F(Options, TakeTheEndsOfTheirRange) {
  table_.set("stage.count", "1");
  table_.set("stage.count", "10");
  table_.set("stage.reach_m", "20");
  EXPECT_EQ(stage_.count, 10);
  EXPECT_EQ(stage_.reach_m, 20);
}

TEST_F(Options, OutOfRangeAreRefusedWithKeyValueAndRange) {
  expect_unset("stage.count", "11", {"stage.count", "'11'", "whole number", "1 … 10"});
  expect_unset("stage.count", "0", {"stage.count", "'0'"});
  expect_unset("stage.reach_m", "-0.5", {"stage.reach_m", "'-0.5'", "0 … 20", "m"});
}

TEST_F(Options, ThatAreNoNumberAreRefused) {
  for (const std::string bad : {"", " 3", "3 ", "3m", "three", "nan", "inf"}) {
    expect_unset("stage.reach_m", bad, {"stage.reach_m", "'" + bad + "'"});
  }
  for (const std::string bad : {"2.5", "1e1", "99999999999999999999"}) {
    expect_unset("stage.count", bad, {"stage.count", "'" + bad + "'"});
  }
}

TEST_F(Options, WithoutARangeTakeAnyFiniteNumber) {
  table_.set("stage.anything", "-1e30");
  EXPECT_EQ(stage_.anything, -1e30);
  expect_unset("stage.anything", "inf", {"any number"});
}

TEST_F(Options, OfTruthTakeTrueAndFalseAlone) {
  expect_unset("stage.enabled", "yes", {"stage.enabled", "'yes'", "true | false"});
  expect_unset("stage.enabled", "1", {"stage.enabled"});
}

TEST_F(Options, OfAnEnumerationAreSetByName) {
  table_.set("stage.pace", "steady");
  EXPECT_EQ(stage_.pace, Pace::steady);
  EXPECT_NE(table_.to_yaml(false).find("  pace: steady\n"), std::string::npos);
  EXPECT_NE(table_.to_yaml(true).find("[brisk | steady]"), std::string::npos);
  table_.load(file("stage:\n  pace: brisk\n"));
  EXPECT_EQ(stage_.pace, Pace::brisk);
  expect_unset("stage.pace", "slow", {"stage.pace", "'slow'", "brisk | steady"});
  expect_unset("stage.pace", "|", {"stage.pace"});
  expect_unset("stage.pace", "", {"stage.pace"});
}

TEST_F(Options, ThatAreListsKeepOrderAndRepetition) {
  using Legs = std::vector<Pace>;
  table_.set("stage.legs", " brisk  steady\tbrisk ");
  EXPECT_EQ(stage_.legs, (Legs{Pace::brisk, Pace::steady, Pace::brisk}));
  EXPECT_NE(table_.to_yaml(false).find("  legs: brisk steady brisk\n"), std::string::npos);
  EXPECT_NE(table_.to_yaml(true).find("[words from brisk, steady]"), std::string::npos);
  expect_unset("stage.legs", "brisk slow", {"stage.legs", "'brisk slow'", "brisk, steady"});
}

TEST_F(Options, ThatAreEmptyListsComeBackFromYaml) {
  table_.set("stage.legs", "");
  EXPECT_TRUE(stage_.legs.empty());
  const std::string yaml = table_.to_yaml(false);
  table_.set("stage.legs", "brisk");
  table_.load(file(yaml));
  EXPECT_TRUE(stage_.legs.empty()) << yaml;
}

TEST(NamedValue, LeadsFromValueToNameAndBack) {
  for (const Pace pace : {Pace::steady, Pace::brisk}) {
    EXPECT_EQ(find_named<Pace>(name_of(pace)), pace);
  }
  EXPECT_EQ(name_of(Pace::brisk), "brisk");
  EXPECT_EQ(find_named<Pace>("slow"), std::nullopt);
  EXPECT_EQ(name_of(static_cast<Pace>(7)), "");
  EXPECT_EQ(all_names<Pace>(", "), "brisk, steady");
}

TEST_F(Options, UnknownAreRefusedWithWhatThereIs) {
  expect_unset("stage.cuont", "3", {"stage.cuont", "'3'", "stage.count", "stage.reach_m"});
  expect_unset("stagee.count", "3", {"stagee.count", "threads", "stage"});
  expect_unset("count", "3", {"count", "threads"});
}

TEST_F(Options, AreAssignedByKeyAndValue) {
  table_.assign("stage.count=4");
  EXPECT_EQ(stage_.count, 4);
  table_.assign("stage.note=a=b");
  EXPECT_EQ(stage_.note, "a=b") << "the first = divides";
  table_.assign("stage.note=");
  EXPECT_EQ(stage_.note, "");
  expect_refusal<UsageError>([&] { table_.assign("stage.count"); },
                             {"stage.count", "group.name=value"});
  expect_refusal<UsageError>([&] { table_.assign("=4"); }, {"group.name=value"});
}

TEST_F(Options, AreLoadedFromYaml) {
  table_.load(file("threads: 2\nstage:\n  count: 9  # comment\n  note: 'x: y'\n"));
  EXPECT_EQ(top_.threads, 2);
  EXPECT_EQ(stage_.count, 9);
  EXPECT_EQ(stage_.note, "x: y");
  EXPECT_EQ(stage_.reach_m, 0.1) << "what is not named stays";
}

TEST_F(Options, OfAnEmptyFileStay) {
  const std::string before = table_.to_yaml(false);
  table_.load(file(""));
  table_.load(file("# all of it\n"));
  table_.load(file("stage:\n"));
  EXPECT_EQ(table_.to_yaml(false), before);
}

TEST_F(Options, OfOtherTablesInASharedFileArePassedOver) {
  StageOptions theirs;
  OptionTable others;
  others.bind("stage", theirs);
  others.bind("other", theirs);
  const auto shared = file("stage:\n  count: 3\nother:\n  count: 4\n");
  table_.load(shared, others);
  EXPECT_EQ(stage_.count, 3);
  EXPECT_EQ(theirs.count, 5) << "read, not written";
  expect_refusal<UsageError>([&] { table_.load(shared); }, {"other.count"});
  expect_refusal<UsageError>([&] { table_.load(file("neither:\n  count: 4\n"), others); },
                             {"neither.count"});
}

TEST_F(Options, InAFileAreRefusedWithFileAndLine) {
  expect_refusal<UsageError>([&] { table_.load(file("threads: 1\nstage:\n  count: 11\n")); },
                             {"options.yaml:3", "stage.count", "'11'"});
  expect_refusal<UsageError>([&] { table_.load(file("stage:\n  count: [1, 2]\n")); },
                             {"options.yaml", "stage.count", "single value"});
  expect_refusal<UsageError>([&] { table_.load(file("other:\n  count: 3\n")); },
                             {"options.yaml:2", "other.count"});
}

TEST_F(Options, ThatAFileGivesTwiceAreRefused) {
  expect_refusal<InputError>([&] { table_.load(file("stage:\n  count: 3\n  count: 4\n")); },
                             {"options.yaml:3", "stage.count", "twice"});
  expect_refusal<InputError>([&] { table_.load(file("stage:\n  count: 3\nstage:\n")); },
                             {"options.yaml:3", "stage", "twice"});
}

TEST_F(Options, OfAFileThatCannotBeReadAreBadInput) {
  expect_refusal<InputError>([&] { table_.load(folder_.path() / "none.yaml"); }, {"none.yaml"});
  expect_refusal<InputError>([&] { table_.load(file("stage: [1\n")); },
                             {"options.yaml", "is not valid YAML"});
  expect_refusal<InputError>([&] { table_.load(file("- 1\n- 2\n")); },
                             {"options.yaml", "map of option groups"});
}

TEST_F(Options, ComeBackFromTheYamlTheyAreWrittenAs) {
  for (const bool with_comments : {false, true}) {
    stage_ = {
        false, 3, 0.1 + 0.2, 1e-300, "a: 'b' # \"c\"", Pace::steady, {Pace::brisk, Pace::steady}};
    const std::string text = table_.to_yaml(with_comments);
    stage_ = {};
    table_.load(file(text));
    EXPECT_FALSE(stage_.enabled);
    EXPECT_EQ(stage_.count, 3);
    EXPECT_EQ(stage_.reach_m, 0.1 + 0.2) << "to the last bit";
    EXPECT_EQ(stage_.anything, 1e-300);
    EXPECT_EQ(stage_.pace, Pace::steady);
    EXPECT_EQ(stage_.legs, (std::vector<Pace>{Pace::brisk, Pace::steady}));
    EXPECT_EQ(stage_.note, "a: 'b' # \"c\"");
  }
}

TEST_F(Options, OfTextThatLooksLikeSomethingElseComeBack) {
  for (const std::string text : {"", "true", "null", "~", "12", "- a", "two\nlines", "ünïcode"}) {
    stage_.note = text;
    const std::string yaml = table_.to_yaml(false);
    stage_.note = "other";
    table_.load(file(yaml));
    EXPECT_EQ(stage_.note, text) << yaml;
  }
}

TEST_F(Options, AreExplainedInComments) {
  const std::string text = table_.to_yaml(true);
  EXPECT_NE(text.find("  # how far [0 … 20, m]\n  reach_m: 0.1\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  # how fast [brisk | steady]\n  pace: brisk\n"), std::string::npos) << text;
}

class NumberLists : public testing::Test {
 protected:
  NumberLists() { table_.bind("stage", stage_); }

  StageOptions stage_;
  OptionTable table_;
};

TEST_F(NumberLists, AreReadWithCommasOrBlanksAndWithOrWithoutBrackets) {
  for (const char* text : {"3, 4e0,5", "[3, 4, 5]", "3 4 5"}) {
    table_.set("stage.stops_m", text);
    EXPECT_EQ(stage_.stops_m, (std::vector<double>{3, 4, 5})) << text;
  }
  table_.set("stage.stops_m", "[]");
  EXPECT_TRUE(stage_.stops_m.empty());
}

TEST_F(NumberLists, RefuseWhatIsNoNumberAndWhatIsOutOfRange) {
  for (const char* text : {"3, far", "3, 11", "-1", "nan"}) {
    EXPECT_THROW(table_.set("stage.stops_m", text), UsageError) << text;
    EXPECT_EQ(stage_.stops_m, (std::vector<double>{1, 2.5})) << text;
  }
}

TEST_F(NumberLists, AreWrittenAndReadAsYamlLists) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "options.yaml";
  std::ofstream(file) << table_.to_yaml(true);
  stage_.stops_m.clear();
  table_.load(file);
  EXPECT_EQ(stage_.stops_m, (std::vector<double>{1, 2.5}));
  std::ofstream(file) << "stage:\n  count: [1, 2]\n";
  EXPECT_THROW(table_.load(file), UsageError) << "a single value";
  std::ofstream(file) << "stage:\n  stops_m: [[1], 2]\n";
  EXPECT_THROW(table_.load(file), UsageError) << "a list of lists";
}

}  // namespace
}  // namespace tofmap

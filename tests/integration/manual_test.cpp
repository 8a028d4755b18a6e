// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

constexpr const char* commands[] = {"simulate",  "record",   "import", "info",
                                    "calibrate", "unwrap",   "map",    "view",
                                    "evaluate",  "register", "config"};

TEST(Manual, PageHasEveryCommandAndSetting) {
  const Finished page = run_program({"manual"});
  ASSERT_EQ(page.status, 0);
  for (const char* command : commands) {
    EXPECT_THAT(page.out, HasSubstr(std::string("\n.SS tofmap ") + command)) << command;
  }
  EXPECT_THAT(page.out, HasSubstr("unwrap.max_range_m"));
  // Each line is either a request that is used here, or text: nothing that roff would swallow.
  std::istringstream lines(page.out);
  for (std::string line; std::getline(lines, line);) {
    const bool is_request = line.starts_with('.') || line.starts_with('\'');
    if (!is_request) continue;
    const std::string request = line.substr(0, 3);
    EXPECT_THAT((std::array{".TH", ".SH", ".SS", ".TP", ".B ", ".I "}), testing::Contains(request))
        << line;
  }
}

TEST(Manual, TableOfOptionsIsThatOfTheDocumentation) {
  const Finished options = run_program({"manual", "options"});
  ASSERT_EQ(options.status, 0);
  EXPECT_EQ(read_text(fs::path(TOFMAP_SOURCE_DIR) / "docs" / "options.md"), options.out)
      << "tofmap manual options > docs/options.md";
}

TEST(Manual, NamesWhatItCanPrint) {
  const Finished finished = run_program({"manual", "zsh"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("bash"));
}

/// What bash offers for the last of some words.
std::string completions(const std::vector<std::string>& words) {
  const TemporaryFolder folder;
  const fs::path script = folder.path() / "completion";
  std::ofstream(script) << run_program({"manual", "bash"}).out;
  std::string line = ". " + script.string() + "; COMP_WORDS=(tofmap";
  for (const std::string& word : words) line += " '" + word + "'";
  line += "); COMP_CWORD=" + std::to_string(words.size()) + "; cd '" + folder.path().string() +
          "'; _tofmap; echo \"${COMPREPLY[@]}\"";
  const fs::path call = folder.path() / "call";
  std::ofstream(call) << line << '\n';
  const std::string command = "bash --norc '" + call.string() + "' 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "bash does not run";
  std::string out;
  std::array<char, 4096> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) out += buffer.data();
  pclose(pipe);
  return out;
}

TEST(Completion, OffersCommandsOptionsAndSettings) {
  EXPECT_EQ(completions({"ev"}), "evaluate\n");
  EXPECT_EQ(completions({"map", "--res"}), "--resume\n");
  EXPECT_EQ(completions({"map", "room", "--set", "unwrap.max_r"}), "unwrap.max_range_m=\n");
  EXPECT_EQ(completions({"map", "--set", "threads=1", "loops.cl"}), "loops.close=\n");
  EXPECT_EQ(completions({"map", "comp"}), "completion\n") << "a file";
  EXPECT_EQ(completions({"info", "--resum"}), "\n") << "no option of that command";
}

TEST(Completion, OffersTheValuesThatAreAllowed) {
  EXPECT_EQ(completions({"map", "room", "--method", "j"}), "joint jump\n");
  EXPECT_EQ(completions({"view", "map", "--from", "i"}), "inside\n");
  EXPECT_EQ(completions({"view", "map", "--from", "=", "i"}), "inside\n");
  EXPECT_EQ(completions({"view", "map", "--color", "c"}), "confidence count\n");
  EXPECT_EQ(completions({"manual", "b"}), "bash\n");
  EXPECT_EQ(completions({"map", "--set", "unwrap.method", "="}),
            "joint jump paper single pixel none\n");
  EXPECT_EQ(completions({"map", "--set", "loops.close", "=", "t"}), "true\n");
  EXPECT_THAT(completions({"map", "--set", "unwrap.max_range_m", "="}), Not(HasSubstr("threads=")));
  EXPECT_THAT(completions({"info", "--set", "loops.close", "="}), Not(HasSubstr("true")))
      << "not of that command";
}

}  // namespace
}  // namespace tofmap::test

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Every file under configs/ does what its folder says, and every link of the documentation leads
// somewhere.

#include "program.hpp"

#include <regex>

#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;

const fs::path source_dir = TOFMAP_SOURCE_DIR;

class ShippedFiles : public WithRecording {};

/// All values that a file sets are in the options that the run had.
void expect_values(const YAML::Node& options, const YAML::Node& file, const fs::path& path) {
  for (const auto& group : file) {
    for (const auto& value : group.second) {
      const YAML::Node had = options[group.first.Scalar()][value.first.Scalar()];
      ASSERT_TRUE(had) << path << ": " << group.first << "." << value.first;
      EXPECT_EQ(had.Scalar(), value.second.Scalar()) << path << ": " << value.first;
    }
  }
}

TEST_F(ShippedFiles, EveryConfigurationIsTakenByItsCommand) {
  // Within two wavelengths, as far as the paper unwraps.
  const Finished simulated =
      run_program({"simulate", "flat", "--out", sequence_.string(), "--frames", "4", "--set",
                   "simulator.width_px=88", "--set", "simulator.height_px=72"});
  ASSERT_EQ(simulated.status, 0) << simulated.err;
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source_dir / "configs")) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string kind = entry.path().parent_path().filename();
    if (kind == "experiments") continue;  // of benchmarks/experiment.py, see CMakeLists.txt
    if (kind == "correlation") continue;  // tests/acquisition/correlation_description_test.cpp
    ++files;
    ASSERT_TRUE(kind == "cameras" || kind == "pipelines") << entry.path();
    const Finished finished =
        kind == "cameras" ? run_program({"simulate", "wall", "--out", out_.string(), "--frames",
                                         "1", "--config", entry.path().string()})
                          : run("map", {"--config", entry.path().string()});
    ASSERT_EQ(finished.status, 0) << entry.path() << ": " << finished.err;
    expect_values(YAML::LoadFile(out_ / "options.yaml"), YAML::LoadFile(entry.path()),
                  entry.path());
    fs::remove_all(out_);
  }
  EXPECT_GE(files, 5);
}

TEST(Documentation, HasNoLinkThatLeadsNowhere) {
  const std::regex link(R"(\]\(([^)#\s]+)(#[^)]*)?\))");
  int links = 0;
  for (const fs::path& folder : {source_dir, source_dir / "docs", source_dir / "configs"}) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() != ".md") continue;
      const std::string text = read_text(entry.path());
      for (std::sregex_iterator found(text.begin(), text.end(), link), end; found != end; ++found) {
        const std::string target = (*found)[1];
        if (target.starts_with("http")) continue;
        ++links;
        EXPECT_TRUE(fs::exists(folder / target)) << entry.path() << ": " << target;
      }
    }
  }
  EXPECT_GT(links, 10);
}

/// All text below a folder.
std::string all_text(const fs::path& folder) {
  std::string text;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) text += read_text(entry.path());
  }
  return text;
}

TEST(Documentation, OfUnwrappingNamesWhatTheCodeHas) {
  const std::string code = all_text(source_dir / "modules/unwrap");
  const std::string text = read_text(source_dir / "docs/unwrapping.md");
  const std::regex name(R"(`(?:tofmap::|unwrap\.)?(?:[A-Za-z_]+::)?([A-Za-z_]+)`)");
  int names = 0;
  for (std::sregex_iterator found(text.begin(), text.end(), name), end; found != end; ++found) {
    ++names;
    EXPECT_NE(code.find((*found)[1]), std::string::npos) << (*found)[0];
  }
  EXPECT_GT(names, 20);
}

}  // namespace
}  // namespace tofmap::test

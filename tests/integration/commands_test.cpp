// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// What each command writes when all is well: the interface that others script against.

#include "program.hpp"

#include <fstream>
#include <set>

#include <gmock/gmock.h>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/cloud/cloud_file.hpp>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;

class Commands : public WithRecording {};

TEST_F(Commands, SimulateWritesAWholeSequence) {
  EXPECT_THAT(names_in(sequence_),
              IsSupersetOf({"amplitude_a", "amplitude_b", "frames.txt", "furniture.json",
                            "groundtruth.txt", "options.yaml", "phase_a", "phase_b", "range_truth",
                            "scene.ply", "sequence.yaml"}));
  EXPECT_EQ(names_in(sequence_ / "phase_a").size(), frames);
}

TEST_F(Commands, SimulateWritesWhatMovesAndNamesWhatFoundNoPlace) {
  const fs::path out = folder_.path() / "moving";
  const Finished finished = run_program({"simulate", "wall", "--out", out.string(), "--frames", "2",
                                         "--set", "simulator.width_px=44", "simulator.height_px=36",
                                         "simulator.people=1", "simulator.doors=8"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_EQ(names_in(out / "moving_truth").size(), 2U);
  // A room of 9 x 5 m lacks the walls for eight doors, 2 m apart, in view.
  EXPECT_THAT(finished.err, HasSubstr("of 8 doors found a place"));
  EXPECT_THAT(finished.err, Not(HasSubstr("people")));
}

TEST_F(Commands, SimulateRearrangesFurnitureAndSaysIfThereIsTooLittle) {
  const auto simulate = [&](const std::string& scene, const std::string& count) {
    return run_program({"simulate", scene, "--out", (folder_.path() / scene).string(), "--frames",
                        "2", "--set", "simulator.width_px=44", "simulator.height_px=36",
                        "simulator.rearranged=" + count, "simulator.walk=1"});
  };
  const Finished room = simulate("room", "3");
  ASSERT_EQ(room.status, 0) << room.err;
  EXPECT_EQ(room.err.find("furniture"), std::string::npos);
  std::set<std::string> states;
  const auto furniture = read_json(folder_.path() / "room" / "furniture.json");
  for (const auto& piece : furniture.at("pieces")) states.insert(piece.at("state"));
  EXPECT_EQ(states, (std::set<std::string>{"gone", "moved", "new", "same"}));
  EXPECT_NE(read_text(folder_.path() / "room" / "scene.ply"), read_text(sequence_ / "scene.ply"));
  EXPECT_NE(read_text(folder_.path() / "room" / "groundtruth.txt"),
            read_text(sequence_ / "groundtruth.txt"));

  const Finished slope = simulate("slope", "2");
  ASSERT_EQ(slope.status, 0) << slope.err;
  EXPECT_THAT(slope.err, HasSubstr("0 of 2 pieces of furniture were rearranged"));
}

TEST_F(Commands, SimulateRepeatsItselfFromTheOptionsItWrote) {
  const fs::path again = folder_.path() / "again";
  const Finished finished = run_program({"simulate", "room", "--out", again.string(), "--config",
                                         (sequence_ / "options.yaml").string()});
  ASSERT_EQ(finished.status, 0) << finished.err;
  for (const std::string file : {"sequence.yaml", "frames.txt", "phase_a/000003.png"}) {
    EXPECT_EQ(read_text(again / file), read_text(sequence_ / file)) << file;
  }
}

TEST_F(Commands, InfoTellsCameraFrequenciesAndFrames) {
  const Finished finished = run("info");
  ASSERT_EQ(finished.status, 0) << finished.err;
  for (const std::string part : {"44 x 36 px", "29.000 MHz", "5.169 m", "31.000 MHz", "4.835 m",
                                 "149.90 m", "frames: 4", "damaged frames: 0"}) {
    EXPECT_THAT(finished.out, HasSubstr(part));
  }
}

TEST_F(Commands, UnwrapWritesImagesOfTheFixedFormats) {
  const Finished finished = run("unwrap");
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_EQ(finished.err, "") << "no progress bar where stderr is no terminal";
  EXPECT_THAT(names_in(out_), ElementsAre(".tofmap-files", "confidence", "options.yaml", "range",
                                          "reason", "report.json", "wraps"));
  EXPECT_THAT(names_in(out_ / "range"),
              ElementsAre("000000.png", "000001.png", "000002.png", "000003.png"));
  const ImageU16 range_mm = read_png_16(out_ / "range" / "000002.png");
  const ImageU8 wraps = read_png_8(out_ / "wraps" / "000002.png");
  const ImageU16 confidence = read_png_16(out_ / "confidence" / "000002.png");
  ASSERT_TRUE(same_size(range_mm, wraps) && same_size(range_mm, confidence));
  EXPECT_TRUE(((range_mm == 0) == (wraps == 255)).all()) << "invalid in one, invalid in all";
  // The wrap count is the range in whole wavelengths; at their bounds noise of both frequencies
  // decides, five standard deviations of some 10 cm in the darkest corners.
  for (Eigen::Index i = 0; i < wraps.size(); ++i) {
    if (wraps.data()[i] == 255) continue;
    const double wavelengths = range_mm.data()[i] / 5168.835;
    EXPECT_NEAR(wavelengths, wraps.data()[i] + 0.5, 0.5 + 0.1);
  }
}

TEST_F(Commands, UnwrapReportsEveryFrame) {
  ASSERT_EQ(run("unwrap").status, 0);
  const auto report = read_json(out_ / "report.json");
  ASSERT_EQ(report["frames"].size(), frames);
  for (int i = 0; i < frames; ++i) {
    EXPECT_EQ(report["frames"][i]["index"], i);
    for (const char* key : {"timestamp", "milliseconds", "iterations", "curl_violations"}) {
      EXPECT_TRUE(report["frames"][i].contains(key)) << key;
    }
  }
  EXPECT_EQ(report["summary"]["frames"], frames);
  EXPECT_EQ(report["summary"]["damaged"], 0);
  EXPECT_EQ(report["summary"]["interrupted"], false);
}

TEST_F(Commands, UnwrapByNoneStaysBelowOneWavelength) {
  ASSERT_EQ(run("unwrap", {"--method", "none"}).status, 0);
  EXPECT_LE(read_png_16(out_ / "range" / "000000.png").maxCoeff(), 5169);
}

TEST_F(Commands, UnwrapFiltersOnRequestAndSaysWhyPixelsAreGone) {
  ASSERT_EQ(run("unwrap", {"--filters", "--set", "filters.min_amplitude=40"}).status, 0);
  const ImageU16 range_mm = read_png_16(out_ / "range" / "000000.png");
  const ImageU8 reason = read_png_8(out_ / "reason" / "000000.png");
  const ImageU16 amplitude = read_png_16(sequence_ / "amplitude_a" / "000000.png");
  EXPECT_TRUE(((range_mm == 0) == (reason != 0)).all());
  EXPECT_GT((reason == 2).count(), 0);
  EXPECT_TRUE((amplitude >= 40 || reason != 0).all());
  const auto removed = read_json(out_ / "report.json")["frames"][0]["removed"];
  EXPECT_EQ(removed["amplitude"], (reason == 2).count());
  EXPECT_EQ(removed["plane_edge"], (reason == 4).count());
}

/// The mean error of the ranges of frame 1 that are off by less than half a metre, millimetres.
double mean_error_mm(const fs::path& out, const fs::path& sequence) {
  const ImageU16 range_mm = read_png_16(out / "range" / "000001.png");
  const ImageU16 truth_mm = read_png_16(sequence / "range_truth" / "000001.png");
  const auto error_mm = (range_mm.cast<double>() - truth_mm.cast<double>()).abs().eval();
  const auto is_counted = (range_mm > 0 && truth_mm > 0 && error_mm < 500).eval();
  return is_counted.select(error_mm, 0).sum() / static_cast<double>(is_counted.count());
}

TEST_F(Commands, UnwrapFusesFramesWhosePosesAreKnown) {
  ASSERT_EQ(run("unwrap").status, 0);
  const double alone_mm = mean_error_mm(out_, sequence_);
  ASSERT_EQ(run("map").status, 0);
  const std::string poses = (folder_.path() / "poses.txt").string();
  fs::copy_file(out_ / "trajectory.txt", poses);
  const Finished finished = run("unwrap", {"--poses", poses});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_LT(mean_error_mm(out_, sequence_), 0.8 * alone_mm);
  const auto report = read_json(out_ / "report.json");
  EXPECT_EQ(report["frames"][0]["fused_views"], 2) << "none before it, two after it";
  EXPECT_EQ(report["frames"][1]["fused_views"], 3);
  EXPECT_EQ(report["frames"].size(), frames);
}

TEST_F(Commands, UnwrapRefusesPosesOfAnotherRecording) {
  const fs::path poses = folder_.path() / "poses.txt";
  std::ofstream(poses) << "12345.6 0 0 0 0 0 0 1\n";
  const Finished finished = run("unwrap", {"--poses", poses.string()});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("poses.txt"), HasSubstr("another recording")));
  EXPECT_EQ(run("unwrap", {"--poses", "/nowhere.txt"}).status, 3);
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(Commands, UnwrapDropsUnsurePixelsOnRequest) {
  ASSERT_EQ(run("unwrap").status, 0);
  const ImageU16 all = read_png_16(out_ / "confidence" / "000000.png");
  ASSERT_EQ(run("unwrap", {"--min-confidence", "0.9"}).status, 0);
  const ImageU16 range_mm = read_png_16(out_ / "range" / "000000.png");
  // Confidences round to 1/65535: leave the two values about the limit out.
  EXPECT_TRUE((all > 58980 || range_mm == 0).all());
  EXPECT_TRUE((all < 58983 || range_mm != 0).all());
}

TEST_F(Commands, ResultIsTheSameForAnyNumberOfThreads) {
  ASSERT_EQ(run("unwrap", {"--threads", "1"}).status, 0);
  const std::string one = read_text(out_ / "range" / "000001.png");
  ASSERT_EQ(run("unwrap", {"--threads", "3"}).status, 0);
  EXPECT_EQ(read_text(out_ / "range" / "000001.png"), one);
  ASSERT_EQ(run("map", {"--threads", "1"}).status, 0);
  const std::string map = read_text(out_ / "map.ply");
  const std::string path = read_text(out_ / "trajectory.txt");
  ASSERT_EQ(run("map", {"--threads", "3"}).status, 0);
  EXPECT_EQ(read_text(out_ / "map.ply"), map);
  EXPECT_EQ(read_text(out_ / "trajectory.txt"), path);
}

TEST_F(Commands, MapWritesMapPathAndReport) {
  const Finished finished = run("map");
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(names_in(out_), IsSupersetOf({"keyframes.txt", "map.ply", "mesh.ply", "options.yaml",
                                            "report.json", "trajectory.txt"}));
  EXPECT_THAT(read_text(out_ / "map.ply").substr(0, 4), "ply\n");
  const auto report = read_json(out_ / "report.json");
  EXPECT_EQ(report["summary"]["registered"], frames);
  EXPECT_EQ(report["frames"].size(), frames);
}

TEST_F(Commands, MapTakesTheOptionsItWrote) {
  ASSERT_EQ(run("map", {"--method", "pixel"}).status, 0);
  const std::string options = read_text(out_ / "options.yaml");
  EXPECT_THAT(options, HasSubstr("method: pixel"));
  std::ofstream(folder_.path() / "again.yaml") << options;
  ASSERT_EQ(run("map", {"--config", (folder_.path() / "again.yaml").string()}).status, 0);
  EXPECT_EQ(read_text(out_ / "options.yaml"), options);
}

TEST_F(Commands, UnwrapDrawsAFewFrames) {
  ASSERT_EQ(run("unwrap", {"--set", "pictures.frames=2"}).status, 0);
  EXPECT_THAT(names_in(out_ / "pictures"),
              ElementsAre("000001_cloud.png", "000001_confidence.png", "000001_range.png",
                          "000001_wraps.png", "000003_cloud.png", "000003_confidence.png",
                          "000003_range.png", "000003_wraps.png"));
}

TEST_F(Commands, UnwrapDrawsTheJumpsOfTheMethodThatHasThem) {
  ASSERT_EQ(run("unwrap", {"--method", "jump", "--set", "pictures.frames=1"}).status, 0);
  EXPECT_THAT(names_in(out_ / "pictures"),
              ElementsAre("000002_cloud.png", "000002_confidence.png", "000002_jumps.png",
                          "000002_range.png", "000002_wraps.png"));
}

TEST_F(Commands, MapDrawsTheRoom) {
  ASSERT_EQ(run("map").status, 0);
  EXPECT_THAT(names_in(out_ / "pictures"), ElementsAre("map_above.png", "map_inside.png"));
}

TEST_F(Commands, ViewMakesAPictureOfWhateverThereIsToSee) {
  ASSERT_EQ(run("map").status, 0);
  const fs::path picture = folder_.path() / "view.png";
  for (const fs::path& path : {out_, out_ / "map.ply", sequence_, sequence_ / "scene.ply"}) {
    for (const std::string from : {"outside", "above", "inside"}) {
      fs::remove(picture);
      const Finished finished =
          run_program({"view", path.string(), "--screenshot", picture.string(), "--from", from,
                       "--width", "160", "--height", "120"});
      EXPECT_EQ(finished.status, 0) << path << finished.err;
      EXPECT_THAT(read_text(picture).substr(1, 3), "PNG") << path;
    }
  }
}

TEST_F(Commands, ViewNamesWhatItCannotShow) {
  const fs::path picture = folder_.path() / "view.png";
  std::ofstream(folder_.path() / "notes.ply") << "no ply";
  fs::create_directory(folder_.path() / "empty");
  for (const std::string name : {"missing", "notes.ply", "empty"}) {
    const Finished finished =
        run_program({"view", (folder_.path() / name).string(), "--screenshot", picture.string()});
    EXPECT_EQ(finished.status, 3) << name;
    EXPECT_THAT(finished.err, HasSubstr(name));
  }
  EXPECT_FALSE(fs::exists(picture));
}

TEST_F(Commands, ViewRefusesWhatDoesNotFitWhatIsThere) {
  const std::string mesh = (sequence_ / "scene.ply").string();
  const fs::path picture = folder_.path() / "view.png";
  const std::vector<std::pair<std::vector<std::string>, std::string>> misfits{
      {{sequence_.string(), "--frame", "99"}, "the recording has 4 frames"},
      {{sequence_.string(), "--cameras"}, "--cameras is for maps"},
      {{mesh, "--frame", "1"}, "--frame is for recordings"},
      {{mesh, "--wrapped"}, "--wrapped is for recordings"},
      {{mesh, "--method", "pixel"}, "--method is for recordings"}};
  for (const auto& [words, trouble] : misfits) {
    std::vector<std::string> command{"view", "--screenshot", picture.string()};
    command.insert(command.end(), words.begin(), words.end());
    const Finished finished = run_program(command);
    EXPECT_EQ(finished.status, 2) << trouble;
    EXPECT_THAT(finished.err, HasSubstr(trouble));
  }
  EXPECT_FALSE(fs::exists(picture));
  const std::string photo = (folder_.path() / "view.jpg").string();
  EXPECT_EQ(run_program({"view", mesh, "--screenshot", photo}).status, 2) << "pictures are PNG";
  EXPECT_FALSE(fs::exists(photo));
}

TEST_F(Commands, ViewShowsTheMapsOfAnEvaluation) {
  ASSERT_EQ(
      run("evaluate", {"--set", "evaluation.methods=none pixel", "--set", "map.min_observations=1"})
          .status,
      0);
  const fs::path picture = folder_.path() / "view.png";
  const auto view = [&](const fs::path& path, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"view", path.string(), "--screenshot", picture.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  };
  ASSERT_EQ(view(out_, {}).status, 0);
  const std::string of_pixel = read_text(picture);
  ASSERT_EQ(view(out_ / "pixel", {}).status, 0);
  EXPECT_TRUE(read_text(picture) == of_pixel) << "the best method is the first";
  ASSERT_EQ(view(out_, {"--method", "none"}).status, 0);
  EXPECT_FALSE(read_text(picture) == of_pixel);
  const Finished missing = view(out_, {"--method", "joint"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("holds the maps of pixel, none"));
  EXPECT_EQ(view(out_, {"--frame", "1"}).status, 2);

  fs::resize_file(out_ / "none" / "map.ply", 100);
  const Finished damaged = view(out_, {});
  EXPECT_EQ(damaged.status, 0) << "another can be read";
  EXPECT_THAT(damaged.err, HasSubstr("left out"));

  write_map(out_ / "none" / "map.ply", MapCloud());
  EXPECT_EQ(view(out_, {}).status, 0) << "one of them has points";
  EXPECT_EQ(view(out_, {"--method", "none"}).status, 3) << "and no other in its place";
}

TEST_F(Commands, ViewColoursByWhatIsAskedFor) {
  ASSERT_EQ(run("map", {"--set", "map.min_observations=1"}).status, 0);
  const auto picture_of = [&](const fs::path& path, const std::vector<std::string>& more) {
    const fs::path picture = folder_.path() / "view.png";
    std::vector<std::string> arguments{"view", path.string(), "--screenshot", picture.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(arguments).status, 0) << path;
    return read_text(picture);
  };
  std::set<std::string> pictures;
  for (const char* color : {"height", "confidence", "count", "plain"}) {
    pictures.insert(picture_of(out_, {"--color", color}));
  }
  pictures.insert(picture_of(out_, {"--cameras"}));
  for (const char* color : {"moved", "range", "wrap", "confidence", "height", "amplitude"}) {
    pictures.insert(picture_of(sequence_, {"--color", color}));
  }
  pictures.insert(picture_of(sequence_, {"--wrapped"}));
  EXPECT_EQ(pictures.size(), 12U) << "each shows something else";
  const Finished finished = run_program({"view", out_.string(), "--color", "wrap"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("height, confidence, count, plain"));
}

TEST_F(Commands, ViewWithoutADisplayNamesTheRemedy) {
  unsetenv("DISPLAY");
  const Finished finished = run_program({"view", sequence_.string()});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("--screenshot"));
}

TEST_F(Commands, EvaluateComparesTheMethods) {
  const Finished finished = run("evaluate");
  ASSERT_EQ(finished.status, 0) << finished.err;
  const auto report = read_json(out_ / "report.json");
  for (const char* method : {"none", "pixel", "single", "paper", "jump", "joint"}) {
    EXPECT_THAT(finished.out, HasSubstr(method));
    const auto& unwrapping = report["unwrapping"][method];
    for (const char* key : {"wrong_wrap_percent", "coverage_percent", "range_rmse_m"}) {
      EXPECT_TRUE(unwrapping[key].is_number()) << method << " " << key;
    }
    // Two counts are too few for this room: with `paper` hardly a frame is registered.
    if (method == std::string("paper")) continue;
    EXPECT_TRUE(report["trajectory"][method]["ate_rmse_m"].is_number()) << method;
  }
  EXPECT_LT(report["unwrapping"]["jump"]["wrong_wrap_percent"],
            report["unwrapping"]["none"]["wrong_wrap_percent"]);
  EXPECT_EQ(report["judgement"]["joint"]["verdict"], "good");
  EXPECT_EQ(report["judgement"]["none"]["verdict"], "bad");
  EXPECT_FALSE(report["judgement"]["none"]["reasons"].empty());
}

TEST_F(Commands, EvaluateComparesTheMethodsThatAreNamedAsFarAsAskedFor) {
  ASSERT_EQ(run("evaluate",
                {"--set", "evaluation.methods=jump none", "--set", "evaluation.down_to=unwrapping"})
                .status,
            0);
  const auto report = read_json(out_ / "report.json");
  EXPECT_EQ(report["unwrapping"].size(), 2);
  EXPECT_LT(report["unwrapping"]["jump"]["wrong_wrap_percent"], 5);
  EXPECT_GT(report["unwrapping"]["none"]["wrong_wrap_percent"], 10);
  EXPECT_FALSE(report.contains("trajectory"));
  EXPECT_FALSE(report.contains("map"));
  const auto& bins = report["over_range"]["none"];
  ASSERT_FALSE(bins.empty());
  EXPECT_EQ(bins.back()["wrong_wrap_percent"], 100) << "beyond one wavelength";
  EXPECT_THAT(names_in(out_),
              ElementsAre(".tofmap-files", "options.yaml", "report.html", "report.json"));
}

TEST_F(Commands, EvaluateDrawsFramesByEveryMethod) {
  ASSERT_EQ(run("evaluate", {"--set", "evaluation.methods=jump none", "--set",
                             "evaluation.down_to=unwrapping", "--set", "pictures.frames=1"})
                .status,
            0);
  EXPECT_THAT(names_in(out_ / "pictures"),
              ElementsAre(HasSubstr("_filters.png"), HasSubstr("_methods.png")));
}

TEST_F(Commands, EvaluateRefusesMethodsThatThereAreNot) {
  for (const std::string methods : {"jump guess", "jump jump", " "}) {
    const Finished finished = run("evaluate", {"--set", "evaluation.methods=" + methods});
    EXPECT_EQ(finished.status, 2) << methods;
    EXPECT_THAT(finished.err, HasSubstr("evaluation.methods"));
  }
}

TEST_F(Commands, ConfigOfACommandCanBeFedBack) {
  const Finished config = run_program({"config", "unwrap"});
  ASSERT_EQ(config.status, 0);
  EXPECT_THAT(config.out, HasSubstr("# "));
  const fs::path file = folder_.path() / "unwrap.yaml";
  std::ofstream(file) << config.out;
  const Finished finished = run("unwrap", {"--config", file.string()});
  EXPECT_EQ(finished.status, 0) << finished.err;
}

TEST_F(Commands, ConfigOfAllCommandsCanBeFedToEach) {
  const fs::path file = folder_.path() / "all.yaml";
  std::ofstream(file) << run_program({"config"}).out;
  for (const std::string command : {"info", "unwrap", "map", "evaluate"}) {
    const Finished finished = run(command, {"--config", file.string()});
    EXPECT_EQ(finished.status, 0) << command << ": " << finished.err;
  }
}

TEST_F(Commands, CommandLineOverrulesTheFile) {
  const fs::path file = folder_.path() / "unwrap.yaml";
  std::ofstream(file) << "unwrap:\n  max_range_m: 20\n  method: single\n";
  ASSERT_EQ(run("unwrap", {"--config", file.string(), "--set", "unwrap.max_range_m=21"}).status, 0);
  const std::string options = read_text(out_ / "options.yaml");
  EXPECT_THAT(options, HasSubstr("max_range_m: 21\n"));
  EXPECT_THAT(options, HasSubstr("method: single\n"));
}

TEST_F(Commands, QuietSaysNothing) {
  const Finished finished = run("map", {"--quiet"});
  EXPECT_EQ(finished.status, 0);
  EXPECT_EQ(finished.out + finished.err, "");
}

TEST(Program, TellsVersionAndHelpOnStdout) {
  for (const std::string flag : {"--version", "--help"}) {
    const Finished finished = run_program({flag});
    EXPECT_EQ(finished.status, 0) << flag;
    EXPECT_NE(finished.out, "") << flag;
    EXPECT_EQ(finished.err, "") << flag;
  }
}

}  // namespace
}  // namespace tofmap::test

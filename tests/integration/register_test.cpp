// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <support/scans.hpp>

#include <tofmap/cloud/point_file.hpp>
#include <tofmap/simulation/scenes.hpp>

namespace tofmap::test {
namespace {

using testing::HasSubstr;

/// Two scans of a room, one of another, as files.
class Register : public testing::Test {
 protected:
  void SetUp() override {
    write("a.ply", scan_of("room", 0));
    write("b.ply", scan_of("room", 1));
    write("elsewhere.ply", scan_of("hall", 0));
  }

  static PointSet scan_of(const std::string& scene_name, double at) {
    const Scene scene = make_scene(scene_name);
    return scan(RayScene(scene.surface), scene.path.pose_at(at));
  }

  /// How far a point three metres before the second cloud's sensor is from its true place in the
  /// first cloud, if both are scans of the room that were moved.
  double error_m(const Pose& first_motion, const Pose& second_motion) const {
    const CameraPath path = make_scene("room").path;
    const Pose first = path.pose_at(0) * first_motion.inverse();
    const Pose second = path.pose_at(1) * second_motion.inverse();
    const std::vector<double> found = read_json(out_ / "transforms.json")["clouds"][1]["transform"];
    Eigen::Matrix4d matrix;
    for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = found[static_cast<std::size_t>(i)];
    const Eigen::Vector3d ahead = second_motion * Eigen::Vector3d(0, 0, 3);
    return ((matrix * ahead.homogeneous()).head<3>() - first.inverse() * second * ahead).norm();
  }

  void write(const std::string& name, const PointSet& points) const {
    write_labelled_points(path(name), {points.points});
  }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  Finished run(const std::vector<std::string>& names, const std::vector<std::string>& more = {},
               const RunLimits& limits = {}) const {
    std::vector<std::string> arguments{"register"};
    for (const std::string& name : names) arguments.push_back(path(name));
    arguments.insert(arguments.end(), {"--out", out_.string()});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, limits);
  }

  TemporaryFolder folder_;
  std::filesystem::path out_ = folder_.path() / "out";
};

TEST_F(Register, PlacesWhatBelongsTogetherAndNamesWhatDoesNot) {
  const Finished finished = run({"a.ply", "elsewhere.ply", "b.ply"});
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("2 of 3 clouds registered"));
  EXPECT_THAT(finished.err, HasSubstr("elsewhere.ply: not registered: fits no other cloud"));
  EXPECT_EQ(names_in(out_), (std::vector<std::string>{".tofmap-files", "merged.ply", "options.yaml",
                                                      "report.json", "transforms.json"}));
  const nlohmann::json clouds = read_json(out_ / "transforms.json")["clouds"];
  ASSERT_EQ(clouds.size(), 3U);
  EXPECT_EQ(clouds[0]["path"], path("a.ply").string());
  const std::vector<double> transform = clouds[0]["transform"];
  EXPECT_EQ(transform, (std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(clouds[0]["converged"], true);
  EXPECT_EQ(clouds[0]["tied_to"], nlohmann::json::array({path("b.ply").string()}));
  EXPECT_GT(clouds[2]["inlier_share"], 0.7);
  EXPECT_LT(clouds[2]["rmse_m"], 0.03);
  EXPECT_TRUE(clouds[1]["transform"].is_null());
  EXPECT_EQ(clouds[1]["converged"], false);
  const std::size_t merged = read_points(out_ / "merged.ply").points.size();
  EXPECT_EQ(merged,
            read_points(path("a.ply")).points.size() + read_points(path("b.ply")).points.size());
  EXPECT_EQ(read_json(out_ / "report.json")["pairs"].size(), 3U);
}

TEST_F(Register, EndsWithBadInputIfNoTwoFitAndSaysHowNearTheyCame) {
  const Finished finished = run({"a.ply", "elsewhere.ply"});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("no two of the clouds could be registered"));
  EXPECT_THAT(finished.out, testing::Not(HasSubstr("merged")));
  EXPECT_FALSE(std::filesystem::exists(out_ / "merged.ply"));
  EXPECT_NE(read_json(out_ / "report.json")["pairs"][0]["verdict"], "registered");
}

TEST_F(Register, NamesFilesThatAreNoClouds) {
  std::ofstream(path("text.ply")) << "no cloud\n";
  for (const std::string name : {"text.ply", "missing.pcd", "a.xyz"}) {
    const Finished finished = run({"a.ply", name});
    EXPECT_EQ(finished.status, 3) << name;
    EXPECT_THAT(finished.err, HasSubstr(name));
    EXPECT_FALSE(std::filesystem::exists(out_));
  }
}

TEST_F(Register, LeavesOutAFileThatIsNoCloudAndPlacesTheOthers) {
  std::ofstream(path("text.ply")) << "no cloud\n";
  const Finished finished = run({"a.ply", "text.ply", "b.ply"});
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("left out: " + path("text.ply").string()));
  EXPECT_THAT(finished.out, HasSubstr("2 of 3 clouds registered"));
  const nlohmann::json clouds = read_json(out_ / "transforms.json")["clouds"];
  ASSERT_EQ(clouds.size(), 3U);
  EXPECT_EQ(clouds[1]["path"], path("text.ply").string());
  EXPECT_TRUE(clouds[1]["transform"].is_null());
  EXPECT_THAT(clouds[1]["damage"], HasSubstr("text.ply"));
  EXPECT_EQ(clouds[2]["converged"], true);
  EXPECT_EQ(read_json(out_ / "report.json")["summary"]["damaged"], 1);
}

TEST_F(Register, LeavesOutPointsAtALimitOfRangeAndPlacesTheOthers) {
  // The spheres have as many points as the surfaces. Only the identity aligns them.
  const std::size_t surfaces = scan_of("room", 0).points.size();
  write("c.ply", with_limit(scan_of("room", 0), 12, 18000));
  write("d.ply", with_limit(scan_of("room", 1), 12, 18000));
  const Finished finished = run({"c.ply", "d.ply"});
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("c.ply: 18000 points at a constant greatest range of 12.00"));
  EXPECT_LT(error_m(Pose::Identity(), Pose::Identity()), 0.02);
  const nlohmann::json cloud = read_json(out_ / "report.json")["clouds"][0];
  EXPECT_EQ(cloud["range_limit"]["points_left_out"], 18000);
  EXPECT_NEAR(cloud["range_limit"]["range"].get<double>(), 12, 0.01);
  EXPECT_EQ(cloud["sensor"], "range_limit");
  EXPECT_EQ(cloud["points"], surfaces);
}

TEST_F(Register, PlacesScansThatWereMovedOutOfTheFramesOfTheirSensors) {
  const Pose little = moved_by({0.3, 0.2, 1}, {0.8, -0.5, 0.3});
  const Pose far = moved_by({0, 1, 0}, {12, 5, -3});
  write("c.ply", moved(scan_of("room", 0), little));
  write("d.ply", moved(scan_of("room", 1), far));
  const Finished finished = run({"c.ply", "d.ply"});
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_LT(error_m(little, far), 0.02);
  const nlohmann::json clouds = read_json(out_ / "report.json")["clouds"];
  EXPECT_NE(clouds[0]["sensor_position"], (nlohmann::json{0, 0, 0}));
}

TEST_F(Register, TakesTheOriginForTheSensorIfItIsTold) {
  const Finished finished = run({"a.ply", "b.ply"}, {"--set", "register.sensor_at_origin=yes"});
  EXPECT_EQ(finished.status, 0) << finished.err;
  const nlohmann::json cloud = read_json(out_ / "report.json")["clouds"][1];
  EXPECT_EQ(cloud["sensor"], "given");
  EXPECT_EQ(cloud["sensor_position"], (nlohmann::json{0.0, 0.0, 0.0}));
}

TEST_F(Register, NamesACloudOfNothingButPointsAtALimitOfRange) {
  write("limit.ply", with_limit({}, 30, 5000));
  const Finished finished = run({"a.ply", "limit.ply"});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("limit.ply: 5000 points at a constant greatest range of "
                                      "30.00, and no others"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(Register, TakesCloudsWhoseNamesAreNotUtf8) {
  const std::string odd = "b\xff.ply";
  std::filesystem::rename(path("b.ply"), path(odd));
  const Finished finished = run({"a.ply", odd});
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_EQ(read_json(out_ / "transforms.json")["clouds"].size(), 2U);
}

TEST_F(Register, WantsTwoCloudsAndKnownMethods) {
  EXPECT_EQ(run({"a.ply"}).status, 2);
  const Finished finished = run({"a.ply", "b.ply"}, {"--set", "register.method=ndt"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("generalised"));
}

TEST_F(Register, LeavesNoHalfResultOnAFullDisk) {
  const Finished finished = run({"a.ply", "b.ply"}, {}, {.max_file_bytes = 50000});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("is the disk full?"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

}  // namespace
}  // namespace tofmap::test

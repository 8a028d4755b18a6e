// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/sample_frames.hpp"
#include "support/temporary_folder.hpp"

#include <cmath>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/calibration/wall_reference.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

SensorModel sensor() {
  SensorModel sensor;
  sensor.camera = {
      .width_px = 88, .height_px = 72, .fx_px = 64, .fy_px = 64, .cx_px = 43.5, .cy_px = 35.5};
  sensor.modulation = {29e6, 31e6};
  return sensor;
}

/// The ranges of a wall whose normal is turned by so much from the optical axis.
ImageF wall_m(double distance_m, double pan_rad, double tilt_rad) {
  const Eigen::Vector3d normal(std::sin(pan_rad), std::sin(tilt_rad) * std::cos(pan_rad),
                               std::cos(tilt_rad) * std::cos(pan_rad));
  const PixelRays rays = pixel_rays(sensor().camera);
  ImageF range_m(72, 88);
  for (Eigen::Index i = 0; i < range_m.size(); ++i) {
    const Eigen::Vector3d ray(rays.x.data()[i], rays.y.data()[i], rays.z.data()[i]);
    range_m.data()[i] = static_cast<float>(distance_m / normal.dot(ray));
  }
  return range_m;
}

Frame frame_of(const ImageF& range_m, double offset_m, double noise_m) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(offset_m, noise_m);
  Frame frame = blank_frame(2);
  frame.phases[0].resize(range_m.rows(), range_m.cols());
  for (Eigen::Index i = 0; i < range_m.size(); ++i) {
    const double cycles = (range_m.data()[i] + noise(random)) / sensor().modulation.wavelength_m(0);
    frame.phases[0].data()[i] = static_cast<float>(cycles - std::floor(cycles));
  }
  frame.phases[1] = frame.phases[0];
  return frame;
}

/// Noise of 2 cm moves a plane fitted to 6000 pixels by less than this at its corners.
constexpr double plane_noise_m = 0.002;

TEST(WallRange, FindsTheTiltOfAWall) {
  for (const double distance_m : {1.0, 4.0, 8.0}) {
    const ImageF truth_m = wall_m(distance_m, 0.06, -0.04);
    const auto found = wall_range(frame_of(truth_m, 0, 0.02), sensor(), distance_m);
    ASSERT_TRUE(found) << distance_m;
    EXPECT_LT((*found - truth_m).abs().maxCoeff(), plane_noise_m * distance_m) << distance_m;
  }
}

TEST(WallRange, IsWhereItIsKnownToBeWhateverTheOffset) {
  const ImageF truth_m = wall_m(3, 0.05, 0.02);
  const auto found = wall_range(frame_of(truth_m, 0.4, 0.02), sensor(), 3);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - truth_m).abs().maxCoeff(), 0.01);
}

TEST(WallRange, LeavesOutWhatStandsBeforeTheWall) {
  const ImageF truth_m = wall_m(3, 0.05, 0.02);
  ImageF seen_m = truth_m;
  seen_m.topRows(20) = 2.2F;
  const auto found = wall_range(frame_of(seen_m, 0, 0.02), sensor(), 3);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - truth_m).abs().maxCoeff(), 0.01);
}

TEST(WallRange, IsFoundIfMoreThanHalfOfTheImageIsWall) {
  const ImageF truth_m = wall_m(3, 0, 0);
  for (const int rows : {32, 40}) {  // of 72
    ImageF seen_m = truth_m;
    for (int v = 0; v < rows; ++v) seen_m.row(v) = 0.5F + 0.03F * static_cast<float>(v);
    EXPECT_EQ(wall_range(frame_of(seen_m, 0, 0.005), sensor(), 3).has_value(), rows < 36) << rows;
  }
}

TEST(WallRange, IsNotFoundWhereThereIsNone) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> anything(0, 5);
  const ImageF noise_m = ImageF::NullaryExpr(72, 88, [&] { return anything(random); });
  EXPECT_FALSE(wall_range(frame_of(noise_m, 0, 0), sensor(), 3));
  Frame empty = frame_of(noise_m, 0, 0);
  empty.phases[0].setConstant(NAN);
  EXPECT_FALSE(wall_range(empty, sensor(), 3));
}

class WallDistancesFile : public testing::Test {
 protected:
  WallDistances read(const std::string& text) {
    const auto file = folder_.path() / "wall.txt";
    std::ofstream(file) << text;
    return read_wall_distances(file);
  }

  std::string complaint(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }

  test::TemporaryFolder folder_;
};

TEST_F(WallDistancesFile, HoldsFramesAndDistances) {
  const WallDistances found = read("# by laser\n0 1.25\n\n  3 2 # the second\n");
  EXPECT_THAT(found, testing::ElementsAre(testing::Pair(0, 1.25), testing::Pair(3, 2)));
}

TEST_F(WallDistancesFile, NamesTheLineThatIsWrong) {
  EXPECT_THAT(complaint("0 1\n1 -2\n"), testing::HasSubstr("wall.txt:2"));
  EXPECT_THAT(complaint("0 1 5\n"), testing::HasSubstr("wall.txt:1"));
  EXPECT_THAT(complaint("0 1\n0 2\n"), testing::HasSubstr("twice"));
  EXPECT_THAT(complaint("0 nan\n"), testing::HasSubstr("wall.txt:1"));
  EXPECT_THAT(complaint("# nothing\n"), testing::HasSubstr("no line"));
  EXPECT_THROW(read_wall_distances(folder_.path() / "none"), InputError);
}

/// What check_wall_distances() says of distances for a recording of two frames; "none" if nothing.
std::string complaint_about(const WallDistances& distances_m) {
  const test::TemporaryFolder folder;
  {
    SequenceWriter writer(folder.path(), test::sample_sensor());
    for (int i = 0; i < 2; ++i) writer.add(test::sample_frame(i));
  }
  try {
    check_wall_distances(distances_m, "wall.txt", SequenceReader(folder.path()));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(WallDistances, AreOfFramesThatTheRecordingHas) {
  EXPECT_EQ(complaint_about({{0, 2.0}, {1, 100.0}}), "none");
  EXPECT_EQ(complaint_about({}), "none");
  EXPECT_THAT(complaint_about({{0, 2.0}, {2, 2.0}}),
              testing::AllOf(testing::HasSubstr("wall.txt"), testing::HasSubstr("frame 2"),
                             testing::HasSubstr("2 frames")));
}

TEST(WallDistances, AreMetres) {
  EXPECT_THAT(complaint_about({{0, 100.5}}), testing::HasSubstr("are its distances metres?"));
}

}  // namespace
}  // namespace tofmap

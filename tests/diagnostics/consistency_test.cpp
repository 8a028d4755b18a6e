// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <deque>

#include <gmock/gmock.h>

#include <tofmap/core/error.hpp>
#include <tofmap/diagnostics/consistency.hpp>

namespace tofmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Modulation modulation{29e6, 31e6};
const CameraModel camera{.width_px = 40,
                         .height_px = 30,
                         .fx_px = 40,
                         .fy_px = 40,
                         .cx_px = 19.5,
                         .cy_px = 14.5,
                         .distortion = {}};

/// What a camera measures at this range everywhere, without noise.
Frame frame_at(double range_m, const Modulation& frequencies = modulation) {
  const auto phase = [&](double wavelength_m) {
    const double cycles = range_m / wavelength_m;
    return ImageF::Constant(camera.height_px, camera.width_px,
                            static_cast<float>(cycles - std::floor(cycles)));
  };
  Frame frame = blank_frame(2);
  frame.phases[0] = phase(frequencies.wavelength_m(0));
  frame.phases[1] = phase(frequencies.wavelength_m(1));
  return frame;
}

/// A frame unwrapped with this count everywhere.
RangeImage image_of(const Frame& frame, int count) {
  RangeImage image(frame.phases[0].rows(), frame.phases[0].cols());
  image.reason.setZero();
  image.wrap_count.setConstant(static_cast<std::uint8_t>(count));
  image.range_m = (frame.phases[0] + static_cast<float>(count)) *
                  static_cast<float>(modulation.wavelength_m(0));
  image.sigma_m.setConstant(0.01F);
  image.confidence.setOnes();
  return image;
}

/// Keeps an image as long as the test program runs: frames with ranges point at theirs.
const RangeImage* kept(RangeImage image) {
  static std::deque<RangeImage> images;
  return &images.emplace_back(std::move(image));
}

TEST(ResidualAgreement, IsPerfectWhereTheCountIsRight) {
  const Frame frame = frame_at(7);
  const ResidualAgreement residual =
      residual_agreement({{&frame, kept(image_of(frame, 1)), {}}}, modulation);
  EXPECT_EQ(residual.misfit_percent, 0);
  EXPECT_NEAR(residual.residual_cycles, 0, 1e-5);
}

TEST(ResidualAgreement, TellsWrongCountsByTheirNeighbourhood) {
  const Frame frame = frame_at(7);
  RangeImage image = image_of(frame, 1);
  image.wrap_count.leftCols(10).setConstant(0);  // a quarter of the pixels
  const ResidualAgreement residual = residual_agreement({{&frame, &image, {}}}, modulation);
  EXPECT_NEAR(residual.misfit_percent, 25, 1e-9);
  // A wrap is off by the difference of the frequencies over that of A: 2 / 29 cycles.
  EXPECT_NEAR(residual.residual_cycles, 2.0 / 29 * std::sqrt(0.25), 1e-4);
}

TEST(ResidualAgreement, TellsWrongCountsOfAnyPairOfFrequencies) {
  struct Pair {
    Modulation frequencies;
    int wrong_by;  ///< the count away that is the nearest miss
  };
  for (const Pair& pair : {Pair{{80e6, 100e6}, 1}, Pair{{30e6, 72e6}, 2}, Pair{{29e6, 31e6}, 1}}) {
    const Frame frame = frame_at(1.2, pair.frequencies);
    const int right = static_cast<int>(1.2 / pair.frequencies.wavelength_m(0));
    EXPECT_EQ(residual_agreement({{&frame, kept(image_of(frame, right)), {}}}, pair.frequencies)
                  .misfit_percent,
              0);
    const RangeImage wrong = image_of(frame, right + pair.wrong_by);
    EXPECT_EQ(residual_agreement({{&frame, &wrong, {}}}, pair.frequencies).misfit_percent, 100)
        << pair.frequencies.frequencies_hz[1];
  }
}

TEST(ResidualAgreement, IsNotKnownOfFrequenciesThatTellNoCounts) {
  const Modulation doubled{20e6, 40e6};
  const Frame frame = frame_at(7, doubled);
  const ResidualAgreement residual =
      residual_agreement({{&frame, kept(image_of(frame, 0)), {}}}, doubled);
  EXPECT_TRUE(std::isnan(residual.misfit_percent)) << "every count fits as well";
  EXPECT_NEAR(residual.residual_cycles, 0, 1e-5);
}

TEST(ResidualAgreement, RefusesImagesOfAnotherSize) {
  const Frame frame = frame_at(7);
  RangeImage image(3, 4);
  EXPECT_THROW(residual_agreement({{&frame, &image, {}}}, modulation), UsageError);
}

TEST(ResidualAgreement, AveragesNoiseOfSinglePixels) {
  Frame frame = frame_at(7);
  const RangeImage image = image_of(frame, 1);
  for (Eigen::Index i = 0; i < frame.phases[1].size(); ++i) {
    frame.phases[1].data()[i] += i % 2 == 0 ? 0.05F : -0.05F;  // more than half a wrap is off
  }
  const ResidualAgreement residual = residual_agreement({{&frame, &image, {}}}, modulation);
  EXPECT_EQ(residual.misfit_percent, 0);
  EXPECT_NEAR(residual.residual_cycles, 0.05, 1e-5);
}

TEST(ResidualAgreement, LeavesOutNeighbourhoodsWhoseNoiseHidesTheWrapCount) {
  Frame frame = frame_at(7);
  RangeImage image = image_of(frame, 1);
  image.wrap_count.leftCols(10).setConstant(0);
  for (Eigen::Index row = 0; row < frame.phases[1].rows(); ++row) {
    for (Eigen::Index col = 20; col < frame.phases[1].cols(); ++col) {
      frame.phases[1](row, col) += (row + col) % 2 == 0 ? 0.2F : -0.2F;  // a mean is off by 0.04
    }
  }
  const double misfit = residual_agreement({{&frame, &image, {}}}, modulation).misfit_percent;
  EXPECT_NEAR(misfit, 100.0 * 10 / 18, 1e-9) << "two columns are near the noise";

  frame.phases[1].leftCols(20) = frame.phases[1].rightCols(20);
  EXPECT_TRUE(std::isnan(residual_agreement({{&frame, &image, {}}}, modulation).misfit_percent));
}

TEST(ResidualAgreement, IsNotKnownWithoutPhases) {
  Frame frame = frame_at(7);
  const RangeImage image = image_of(frame, 1);
  frame.phases[1].setConstant(NAN);
  EXPECT_TRUE(std::isnan(residual_agreement({{&frame, &image, {}}}, modulation).misfit_percent));
  EXPECT_TRUE(std::isnan(residual_agreement({}, modulation).residual_cycles));
}

TEST(AmbiguousPercent, CountsPixelsWithAReturn) {
  const Frame frame = frame_at(7);
  RangeImage image = image_of(frame, 1);
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index col = 0; col < image.cols(); ++col) {
      image.invalidate(row, col, row < 3 ? InvalidReason::ambiguous : InvalidReason::no_return);
    }
  }
  EXPECT_NEAR(ambiguous_percent({{&frame, &image, {}}}), 100 * 3.0 / 27, 1e-9);
  EXPECT_TRUE(std::isnan(ambiguous_percent({})));
}

TEST(ContradictedPercent, IsZeroForFramesThatAgreeWhereverTheCameraWas) {
  const Frame far = frame_at(7);
  const Frame near = frame_at(6);
  Pose step = Pose::Identity();
  step.translation().z() = 1;
  // A sphere around the first camera is none around the second; near its pole it almost is.
  const CameraModel narrow{.width_px = 40,
                           .height_px = 30,
                           .fx_px = 200,
                           .fy_px = 200,
                           .cx_px = 19.5,
                           .cy_px = 14.5,
                           .distortion = {}};
  EXPECT_EQ(contradicted_percent({{&far, kept(image_of(far, 1)), Pose::Identity()},
                                  {&near, kept(image_of(near, 1)), step}},
                                 narrow),
            0);
}

TEST(ContradictedPercent, CountsWhatOtherFramesSeeThrough) {
  const Frame frame = frame_at(7);
  const RangedFrame right{&frame, kept(image_of(frame, 1)), Pose::Identity()};
  const RangedFrame wrapped{&frame, kept(image_of(frame, 0)), Pose::Identity()};
  // Points of the right one are hidden behind the wrapped ones, these are seen through.
  EXPECT_EQ(contradicted_percent({right, wrapped}, camera), 100);
  EXPECT_NEAR(contradicted_percent({right, right, wrapped}, camera), 50, 1e-9);
}

TEST(ContradictedPercent, NeedsFramesThatOverlap) {
  const Frame frame = frame_at(7);
  const RangedFrame registered{&frame, kept(image_of(frame, 1)), Pose::Identity()};
  const RangedFrame lost{&frame, kept(image_of(frame, 1)), {}};
  EXPECT_TRUE(std::isnan(contradicted_percent({registered, lost}, camera)));
  RangedFrame behind = registered;
  behind.world_from_camera->linear() =
      Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_TRUE(std::isnan(contradicted_percent({registered, behind}, camera)));
}

/// Walls of 2 x 2 m at these depths, a point every 4 cm.
MapCloud walls(const std::vector<double>& depths_m) {
  MapCloud map;
  for (const double depth_m : depths_m) {
    for (int i = 0; i < 50; ++i) {
      for (int j = 0; j < 50; ++j) {
        MapPoint point{};
        point.getVector3fMap() = Eigen::Vector3d(0.04 * i, 0.04 * j, depth_m).cast<float>();
        point.getNormalVector3fMap() = -Eigen::Vector3f::UnitZ();
        map.push_back(point);
      }
    }
  }
  return map;
}

TEST(PlaneThickness, TellsAWallThatIsThereTwice) {
  EXPECT_NEAR(plane_thickness_m(walls({3})), 0, 1e-6);
  EXPECT_NEAR(plane_thickness_m(walls({3, 3.06})), 0.03, 0.005);
  EXPECT_NEAR(plane_thickness_m(walls({3, 4})), 0, 1e-6) << "two walls";
}

TEST(PlaneThickness, PassesOverEdgesAndBacks) {
  MapCloud panel = walls({3, 3.05});
  for (std::size_t i = panel.size() / 2; i < panel.size(); ++i) {
    panel[i].getNormalVector3fMap() = Eigen::Vector3f::UnitZ();
  }
  EXPECT_NEAR(plane_thickness_m(panel), 0, 1e-6);
  MapCloud rough = walls({3});
  for (std::size_t i = 0; i < rough.size(); ++i) {
    if (i % 2 == 0) rough[i].getNormalVector3fMap() = Eigen::Vector3f::UnitX();
  }
  EXPECT_TRUE(std::isnan(plane_thickness_m(rough)));
  EXPECT_TRUE(std::isnan(plane_thickness_m({})));
}

TEST(ConsistencyWarnings, BeginBeyondTheirLimits) {
  Consistency consistency;
  consistency.contradicted_percent = 3;
  consistency.residual_misfit_percent = 10;
  consistency.view_disagreement_m = 0.006;
  EXPECT_THAT(warnings_about(consistency), IsEmpty());
  consistency.contradicted_percent = 3.1;
  EXPECT_THAT(warnings_about(consistency),
              ElementsAre(HasSubstr("contradict each other in 3.1 %")));
  consistency.residual_misfit_percent = 11;
  EXPECT_THAT(warnings_about(consistency), ElementsAre(HasSubstr("contradict"), HasSubstr("11 %")));
  consistency = {};
  consistency.view_disagreement_m = 0.0074;
  EXPECT_THAT(warnings_about(consistency), ElementsAre(HasSubstr("disagree by 7 mm")));
}

TEST(ConsistencyWarnings, AreNoneAboutWhatIsNotKnown) {
  EXPECT_THAT(warnings_about(unknown_consistency()), IsEmpty());
}

TEST(ConsistencyFrames, AreFewerOfLargeImagesButNotTooFew) {
  const auto frames_of = [](int width_px, int height_px) {
    CameraModel resized = camera;
    resized.width_px = width_px;
    resized.height_px = height_px;
    return consistency_frames(resized);
  };
  EXPECT_EQ(frames_of(176, 144), 60);
  EXPECT_EQ(frames_of(500, 400), 30);
  EXPECT_EQ(frames_of(640, 480), 20);
  EXPECT_EQ(frames_of(4000, 3000), 20);
}

}  // namespace
}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_ranges.hpp"

#include <cmath>
#include <deque>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/diagnostics/view_disagreement.hpp>

namespace tofmap {
namespace {

/// Changes the ranges of a frame, given the number of the frame.
using Change = std::function<void(int number, RangeImage& image)>;

/// Views of a box from places along a line and in several directions, with changed ranges.
class Views {
 public:
  explicit Views(const Change& change = {}) {
    for (int i = 0; i < 12; ++i) {
      const Pose pose = test::moved_by({0, 0.08 * i - 0.4, 0.02 * i}, {0.1 * i - 0.6, 0, 0});
      RangeImage& image =
          images_.emplace_back(test::box_ranges(camera_, {-2, -1.5, -2}, {2.5, 1.5, 4}, pose));
      if (change) change(i, image);
      frames_.push_back({nullptr, &image, pose});
    }
  }

  double disagreement_m() const { return view_disagreement_m(frames_, camera_); }
  std::vector<RangedFrame>& frames() { return frames_; }
  const CameraModel& camera() const { return camera_; }

 private:
  CameraModel camera_ = test::small_camera();
  std::deque<RangeImage> images_;
  std::vector<RangedFrame> frames_;
};

TEST(ViewDisagreement, IsNothingForExactRanges) { EXPECT_LT(Views().disagreement_m(), 1e-4); }

TEST(ViewDisagreement, IsFreeOfNoise) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise_m(0, 0.03F);
  const Views noisy([&](int, RangeImage& image) {
    for (float& range_m : image.range_m.reshaped()) range_m += noise_m(random);
    image.sigma_m.setConstant(0.03F);
  });
  // The planes of two patches of 64 pixels, at their centres, differ by 5 mm.
  EXPECT_LT(noisy.disagreement_m(), 0.0015);
}

TEST(ViewDisagreement, IsThatOfRangesWhoseErrorDependsOnTheView) {
  // Alternating frames measure 8 mm too much and too little: half of the pairs differ by 16 mm.
  const Views biased(
      [](int number, RangeImage& image) { image.range_m += number % 2 == 0 ? 0.008F : -0.008F; });
  EXPECT_NEAR(biased.disagreement_m(), 0.016 * std::sqrt(0.5), 0.003);
}

TEST(ViewDisagreement, GrowsWithErrorsOfPoses) {
  Views moved;
  for (std::size_t i = 0; i < moved.frames().size(); i += 2) {
    moved.frames()[i].world_from_camera->translation() += Eigen::Vector3d(0.01, 0.01, 0.01);
  }
  // Walls are moved by 1 cm in half of the pairs.
  EXPECT_NEAR(moved.disagreement_m(), 0.01 * std::sqrt(0.5), 0.002);
}

TEST(ViewDisagreement, IsNotDecidedByWhatMoves) {
  // In every second frame, a tenth of the image shows something 20 cm before the wall.
  const Views passed_by([](int number, RangeImage& image) {
    if (number % 2 == 0) image.range_m.leftCols(9) -= 0.2F;
  });
  EXPECT_LT(passed_by.disagreement_m(), 0.003);
}

TEST(ViewDisagreement, IsUnknownWithoutOverlap) {
  Views views;
  views.frames().resize(1);
  EXPECT_TRUE(std::isnan(views.disagreement_m()));
  Views lost;
  for (RangedFrame& frame : lost.frames()) frame.world_from_camera.reset();
  EXPECT_TRUE(std::isnan(lost.disagreement_m()));
  Views blind([](int, RangeImage& image) {
    for (int row = 0; row < image.rows(); ++row) {
      for (int col = 0; col < image.cols(); ++col) {
        image.invalidate(row, col, InvalidReason::no_return);
      }
    }
  });
  EXPECT_TRUE(std::isnan(blind.disagreement_m()));
}

TEST(ViewDisagreement, MeetsImagesSmallerThanAPatch) {
  CameraModel camera = test::small_camera();
  camera.width_px = 6;
  camera.height_px = 4;
  const RangeImage image(4, 6);
  EXPECT_TRUE(std::isnan(view_disagreement_m({{nullptr, &image, Pose::Identity()}}, camera)));
}

}  // namespace
}  // namespace tofmap

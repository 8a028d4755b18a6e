// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"
#include "support/box_ranges.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/filters/view_fusion.hpp>

namespace tofmap {
namespace {

using test::box_ranges;
using test::moved_by;
using test::small_camera;

/// Views from several places in a box of 4 x 3 x 6 m.
class ViewFusion : public testing::Test {
 protected:
  static constexpr std::size_t count = 5;

  ViewFusion() {
    for (std::size_t i = 0; i < count; ++i) {
      const double step = static_cast<double>(i) - 2;
      poses_.push_back(moved_by({0.01 * step, 0.03 * step, 0}, {0.05 * step, 0.01, 0.02 * step}));
      truth_.push_back(box_ranges(small_camera(), {-2, -1.5, -3}, {2, 1.5, 3}, poses_.back()));
    }
    images_ = truth_;
  }

  /// The middle view, fused with all others.
  RangeImage fused(const FusionOptions& options = {}) const {
    std::vector<PosedView> others;
    for (std::size_t i = 0; i < count; ++i) {
      if (i != middle) others.push_back({&images_[i], poses_[i]});
    }
    return fuse_views({&images_[middle], poses_[middle]}, others, small_camera(), rays_, options);
  }

  /// The root mean square error of the pixels that all views see.
  double rmse_m(const RangeImage& image) const {
    return std::sqrt(
        (image.range_m - truth_[middle].range_m).block(10, 15, 52, 58).square().mean());
  }

  static constexpr std::size_t middle = 2;
  PixelRays rays_ = pixel_rays(small_camera());
  std::vector<Pose> poses_;
  std::vector<RangeImage> truth_;
  std::vector<RangeImage> images_;
};

TEST_F(ViewFusion, LeavesExactRangesWhereTheyAre) {
  const RangeImage out = fused();
  EXPECT_EQ(out.count_valid(), 72 * 88);
  // But for quads across the edges between walls, whose mean cuts the corner, by half of what is
  // between two pixels at most.
  const auto moved = ((out.range_m - images_[middle].range_m).abs() > 1e-3F).count();
  EXPECT_LT(moved, 72 * 88 / 20);
  EXPECT_LT((out.range_m - images_[middle].range_m).abs().maxCoeff(), 3.0F / 64 / 2);
}

TEST_F(ViewFusion, AveragesWhatSystematicErrorsExplainAndLessensNoiseAlone) {
  for (RangeImage& image : images_) image.sigma_m.setConstant(0.002F);
  for (std::size_t i = 0; i < count; ++i) {
    if (i != middle) images_[i].range_m -= 0.08F;  // 40 of the noise, 2 with what is systematic
  }
  FusionOptions strict;
  strict.tolerance_m = 0;
  const RangeImage apart = fused(strict);
  EXPECT_LT((apart.range_m - images_[middle].range_m).abs().block(10, 15, 52, 58).mean(), 0.002F);
  for (RangeImage& image : images_) image.systematic_m = 0.03;
  const RangeImage together = fused(strict);
  EXPECT_LT((together.range_m - images_[middle].range_m).block(10, 15, 52, 58).mean(), -0.02F);
  EXPECT_EQ(together.systematic_m, 0.03);
  EXPECT_LT(together.sigma_m.block(10, 15, 52, 58).mean(), 0.0015F);
}

TEST_F(ViewFusion, LessensNoise) {
  for (std::size_t i = 0; i < count; ++i) {
    images_[i] = test::with_noise(truth_[i], 0.02F, static_cast<unsigned>(i + 1));
  }
  const RangeImage out = fused();
  // Five views, the others' means of four pixels: at best 1 / sqrt(1 + 4 · 2) of it.
  EXPECT_LT(rmse_m(out), 0.5 * rmse_m(images_[middle]));
  EXPECT_GT(out.count_valid(), 0.999 * 72 * 88);
  // sigma_m says so, too.
  const double predicted_m = std::sqrt(out.sigma_m.block(10, 15, 52, 58).square().mean());
  EXPECT_NEAR(predicted_m, rmse_m(out), 0.3 * rmse_m(out));
}

TEST_F(ViewFusion, DropsWhatOtherViewsSeeThrough) {
  images_[middle].range_m(36, 44) -= 1;
  const RangeImage out = fused();
  EXPECT_EQ(out.reason(36, 44), static_cast<int>(InvalidReason::free_space_violation));
  EXPECT_EQ(out.count_valid(), 72 * 88 - 1);
}

TEST_F(ViewFusion, KeepsWhatOtherViewsHaveHidden) {
  images_[middle].range_m(36, 44) += 1;
  const RangeImage out = fused();
  EXPECT_TRUE(out.valid(36, 44));
  EXPECT_FLOAT_EQ(out.range_m(36, 44), images_[middle].range_m(36, 44));
}

TEST_F(ViewFusion, TakesMoreThanOneViewToDrop) {
  images_[middle].range_m(36, 44) -= 1;
  const PosedView one{&images_[1], poses_[1]};
  const RangeImage out =
      fuse_views({&images_[middle], poses_[middle]}, {&one, 1}, small_camera(), rays_, {});
  EXPECT_TRUE(out.valid(36, 44));
}

TEST_F(ViewFusion, InventsNothing) {
  images_[middle].invalidate(36, 44, InvalidReason::low_amplitude);
  const RangeImage out = fused();
  EXPECT_EQ(out.reason(36, 44), static_cast<int>(InvalidReason::low_amplitude));
  EXPECT_EQ(out.count_valid(), 72 * 88 - 1);
}

TEST_F(ViewFusion, ChangesNothingWithoutOtherViews) {
  const RangeImage out =
      fuse_views({&images_[middle], poses_[middle]}, {}, small_camera(), rays_, {});
  EXPECT_LT((out.range_m - images_[middle].range_m).abs().maxCoeff(), 1e-6F);
  EXPECT_LT((out.sigma_m - images_[middle].sigma_m).abs().maxCoeff(), 1e-6F);
}

TEST_F(ViewFusion, PassesOverViewsThatLookElsewhere) {
  poses_[1] = moved_by({0, 3.1, 0}, {0, 0, 0});
  EXPECT_EQ(fused().count_valid(), 72 * 88);
}

TEST_F(ViewFusion, RefusesViewsOfAnotherSize) {
  images_[1] = test::plane(3);
  EXPECT_THROW(fused(), UsageError);
}

}  // namespace
}  // namespace tofmap

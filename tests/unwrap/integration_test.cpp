// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <tofmap/unwrap/jump/jump_integration.hpp>
#include <tofmap/unwrap/jump/jump_propagation.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {
namespace {

/// Counts that differ by at most one between neighbours: a sum of random steps along either axis.
Image<int> random_field(Eigen::Index rows, Eigen::Index cols, std::mt19937& random) {
  std::uniform_int_distribution<int> half_step(0, 1);
  Image<int> field(rows, cols);
  std::vector<int> row_part(static_cast<std::size_t>(rows), 0);
  std::vector<int> col_part(static_cast<std::size_t>(cols), 0);
  for (std::size_t i = 1; i < row_part.size(); ++i)
    row_part[i] = row_part[i - 1] + half_step(random);
  for (std::size_t i = 1; i < col_part.size(); ++i)
    col_part[i] = col_part[i - 1] - half_step(random);
  for (Eigen::Index v = 0; v < rows; ++v) {
    for (Eigen::Index u = 0; u < cols; ++u) {
      field(v, u) = row_part[static_cast<std::size_t>(v)] + col_part[static_cast<std::size_t>(u)];
    }
  }
  return field;
}

/// Certain jumps of a field: configuration i with n(q) − n(p) = −i.
JumpProbabilities jumps_of(const Image<int>& field) {
  JumpProbabilities jumps;
  for (ImageF& plane : jumps.x) plane = ImageF::Constant(field.rows(), field.cols() - 1, 0.01F);
  for (ImageF& plane : jumps.y) plane = ImageF::Constant(field.rows() - 1, field.cols(), 0.01F);
  for (Eigen::Index v = 0; v < field.rows(); ++v) {
    for (Eigen::Index u = 0; u < field.cols(); ++u) {
      if (u + 1 < field.cols()) {
        jumps.x[static_cast<std::size_t>(field(v, u) - field(v, u + 1) + 1)](v, u) = 0.98F;
      }
      if (v + 1 < field.rows()) {
        jumps.y[static_cast<std::size_t>(field(v, u) - field(v + 1, u) + 1)](v, u) = 0.98F;
      }
    }
  }
  return jumps;
}

TEST(Integration, OfTheJumpsOfAFieldGivesTheFieldBack) {
  std::mt19937 random(7);
  std::uniform_int_distribution<Eigen::Index> size(2, 20);
  for (int trial = 0; trial < 50; ++trial) {
    const Image<int> field = random_field(size(random), size(random), random);
    const ImageU8 valid = ImageU8::Ones(field.rows(), field.cols());
    const JumpProbabilities jumps = jumps_of(field);
    const RelativeCounts counts = integrate_jumps(jumps, jumps, valid);
    ASSERT_EQ(counts.region_count, 1);
    const int constant = field(0, 0) - counts.count(0, 0);
    EXPECT_TRUE((counts.count + constant == field).all()) << "trial " << trial;
  }
}

TEST(Integration, KeepsRegionsApartThatNoReturnSeparates) {
  const Image<int> field = Image<int>::Zero(4, 5);
  ImageU8 valid = ImageU8::Ones(4, 5);
  valid.col(2).setZero();
  JumpProbabilities jumps = jumps_of(field);
  for (ImageF& plane : jumps.x) plane.middleCols(1, 2).setConstant(NAN);
  for (ImageF& plane : jumps.y) plane.col(2).setConstant(NAN);
  const RelativeCounts counts = integrate_jumps(jumps, jumps, valid);
  EXPECT_EQ(counts.region_count, 2);
  EXPECT_NE(counts.region(0, 0), counts.region(0, 4));
  EXPECT_EQ(counts.region(0, 2), RelativeCounts::no_region);
}

TEST(Integration, TakesTheMostCertainPathAroundAWrongJump) {
  Image<int> field = Image<int>::Zero(3, 3);
  JumpProbabilities jumps = jumps_of(field);
  // A wrong jump, less certain than all others.
  jumps.x[0](1, 1) = 0.6F;
  jumps.x[1](1, 1) = 0.4F;
  const RelativeCounts counts = integrate_jumps(jumps, jumps, ImageU8::Ones(3, 3));
  EXPECT_TRUE((counts.count == counts.count(0, 0)).all());
}

TEST(Integration, TrustsLeastTheNodeThatWasPersuaded) {
  // Every belief is as good as sure, but one contradicts what its own node saw.
  const Image<int> field = Image<int>::Zero(3, 3);
  const JumpProbabilities evidence = jumps_of(field);
  JumpProbabilities beliefs = evidence;
  beliefs.x[0](1, 1) = 0.9999F;
  beliefs.x[1](1, 1) = 0.0001F;
  const RelativeCounts counts = integrate_jumps(beliefs, evidence, ImageU8::Ones(3, 3));
  EXPECT_TRUE((counts.count == counts.count(0, 0)).all());
}

/// A frame of two flat walls side by side, without noise worth speaking of.
struct TwoWalls {
  SensorModel sensor;
  Frame frame = blank_frame(2);
  ImageF range_m;
};

TwoWalls two_walls(double left_m, double right_m) {
  TwoWalls walls;
  walls.sensor.modulation = {29e6, 31e6};
  walls.sensor.max_range_m = 20;
  walls.range_m = ImageF::Constant(16, 24, static_cast<float>(left_m));
  walls.range_m.rightCols(12).setConstant(static_cast<float>(right_m));
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 0.001F);
  const auto phase = [&](double wavelength_m) {
    return ImageF(walls.range_m.unaryExpr([&](float range) {
      const auto cycles = static_cast<float>(range / wavelength_m) + noise(random);
      return cycles - std::floor(cycles);
    }));
  };
  walls.frame.phases[0] = phase(walls.sensor.modulation.wavelength_m(0));
  walls.frame.phases[1] = phase(walls.sensor.modulation.wavelength_m(1));
  return walls;
}

double largest_error_m(const TwoWalls& walls, const RangeImage& image) {
  return (image.range_m - walls.range_m).abs().maxCoeff();
}

UnwrapOptions jump_options() {
  UnwrapOptions options;
  options.method = UnwrapMethod::jump;
  return options;
}

TEST(JumpMethod, IsRightAcrossAStepOfExactlyOneWavelength) {
  // The wrapped image shows no edge at all: only the residual can tell.
  TwoWalls walls = two_walls(3, 3 + 5.1688);
  const UnwrapResult result = unwrap(walls.frame, walls.sensor, jump_options());
  EXPECT_LT(largest_error_m(walls, result.image), 0.1);
}

TEST(JumpMethod, TellsTheAbsoluteCountOfASceneBeyondOneWavelength) {
  TwoWalls walls = two_walls(7, 11);
  const UnwrapResult result = unwrap(walls.frame, walls.sensor, jump_options());
  EXPECT_LT(largest_error_m(walls, result.image), 0.1);
  EXPECT_EQ(result.image.wrap_count(0, 0), 1);
  EXPECT_EQ(result.image.wrap_count(0, 20), 2);
}

UnwrapOptions paper_options() {
  UnwrapOptions options;
  options.method = UnwrapMethod::paper;
  return options;
}

TEST(PaperMethod, AddsOneWavelengthWhereRangesAreWrapped) {
  TwoWalls walls = two_walls(3, 9);
  const UnwrapResult result = unwrap(walls.frame, walls.sensor, paper_options());
  EXPECT_LT(largest_error_m(walls, result.image), 0.1);
  EXPECT_EQ(result.regions, 1);
}

TEST(PaperMethod, KnowsNoCountOfASceneBeyondOneWavelength) {
  // Jumps tell differences of counts alone, and the least count is 0.
  TwoWalls walls = two_walls(7, 11);
  const UnwrapResult result = unwrap(walls.frame, walls.sensor, paper_options());
  EXPECT_EQ(result.image.wrap_count(0, 0), 0);
}

TEST(PaperMethod, HasTwoCountsHoweverFarASurfaceReaches) {
  // A wall that recedes from 4 to 12 m, and so crosses both 5.2 and 10.3 m.
  TwoWalls walls = two_walls(4, 4);
  const Modulation modulation = walls.sensor.modulation;
  for (Eigen::Index u = 0; u < 24; ++u) {
    const double range_m = 4 + 8.0 * static_cast<double>(u) / 23;
    walls.frame.phases[0].col(u) =
        static_cast<float>(std::fmod(range_m / modulation.wavelength_m(0), 1));
    walls.frame.phases[1].col(u) =
        static_cast<float>(std::fmod(range_m / modulation.wavelength_m(1), 1));
  }
  const auto counts = [&](const UnwrapOptions& options) {
    return unwrap(walls.frame, walls.sensor, options).image.wrap_count;
  };
  EXPECT_EQ(counts(paper_options())(8, 12), 1);
  EXPECT_EQ(counts(paper_options())(8, 23), 1);
  EXPECT_EQ(counts(jump_options())(8, 12), 1);
  EXPECT_EQ(counts(jump_options())(8, 23), 2);
}

TEST(JumpMethod, WorksWhenBHasTheLongerWavelength) {
  TwoWalls walls = two_walls(3, 9);
  std::swap(walls.frame.phases[0], walls.frame.phases[1]);
  std::swap(walls.sensor.modulation.frequencies_hz[0], walls.sensor.modulation.frequencies_hz[1]);
  const UnwrapResult result = unwrap(walls.frame, walls.sensor, jump_options());
  EXPECT_LT(largest_error_m(walls, result.image), 0.1);
}

TEST(Unwrapping, GivesPixelsWithoutAReturnNoRange) {
  TwoWalls walls = two_walls(3, 9);
  walls.frame.phases[1](4, 4) = NAN;
  const UnwrapResult result = unwrap(walls.frame, walls.sensor, {});
  EXPECT_FALSE(result.image.valid(4, 4));
  EXPECT_TRUE(std::isnan(result.image.range_m(4, 4)));
  EXPECT_EQ(result.image.wrap_count(4, 4), invalid_wrap_count);
  EXPECT_EQ(result.image.count_valid(), 16 * 24 - 1);
}

TEST(Unwrapping, OfAMeasuredFrameDoesNotDependOnTheFramesBefore) {
  TwoWalls near = two_walls(3, 9);
  TwoWalls far = two_walls(18, 7);
  far.frame.phases[0].block(0, 20, 9, 4).setConstant(NAN);
  TwoWalls small = two_walls(4, 12);
  for (ImageF* phase : {&small.frame.phases[0], &small.frame.phases[1]}) {
    *phase = ImageF(phase->topLeftCorner(11, 7));
  }
  for (const char* method : {"joint", "jump", "paper", "single"}) {
    UnwrapOptions options;
    options.method = find_named<UnwrapMethod>(method).value();
    FrameMeasurer measurer(near.sensor, options);
    Unwrapper unwrapper(near.sensor, options);
    for (const TwoWalls* walls : {&near, &far, &small, &near, &near}) {
      const MeasuredFrame measured = measurer.measure(walls->frame);
      const RangeImage kept = unwrapper.unwrap(measured).image;
      const RangeImage fresh = Unwrapper(near.sensor, options).unwrap(measured).image;
      EXPECT_TRUE((kept.wrap_count == fresh.wrap_count).all()) << method;
      EXPECT_TRUE((kept.confidence == fresh.confidence).all()) << method;
      EXPECT_TRUE((kept.range_m == fresh.range_m || kept.range_m.isNaN()).all()) << method;
    }
  }
}

TEST(Unwrapping, OfTheSameFramesInTheSameOrderGivesTheSameBits) {
  const TwoWalls near = two_walls(3, 9);
  const TwoWalls far = two_walls(18, 7);
  for (const char* method : {"joint", "jump", "paper", "single", "pixel", "none"}) {
    UnwrapOptions options;
    options.method = find_named<UnwrapMethod>(method).value();
    Unwrapper one(near.sensor, options);
    Unwrapper other(near.sensor, options);
    FrameMeasurer measurer(near.sensor, options);
    for (const TwoWalls* walls : {&near, &far, &near, &near}) {
      const RangeImage first = one.unwrap(walls->frame).image;
      const RangeImage second = other.unwrap(measurer.measure(walls->frame)).image;
      EXPECT_TRUE((first.wrap_count == second.wrap_count).all()) << method;
      EXPECT_TRUE((first.confidence == second.confidence).all()) << method;
      EXPECT_TRUE((first.range_m == second.range_m || first.range_m.isNaN()).all()) << method;
    }
  }
}

TEST(Unwrapping, SaysWhichPixelsAreSaturated) {
  TwoWalls walls = two_walls(3, 9);
  walls.sensor.saturation_amplitude = 1000;
  walls.frame.amplitudes[0] = ImageF::Constant(16, 24, 100);
  walls.frame.amplitudes[1] = walls.frame.amplitudes[0];
  walls.frame.amplitudes[1](4, 4) = 1000;
  walls.frame.amplitudes[0](5, 5) = 2000;
  walls.frame.phases[0](6, 6) = NAN;
  walls.frame.amplitudes[1](6, 6) = 2000;
  const RangeImage image = unwrap(walls.frame, walls.sensor, {}).image;
  EXPECT_EQ(image.reason(4, 4), static_cast<int>(InvalidReason::saturated));
  EXPECT_EQ(image.reason(5, 5), static_cast<int>(InvalidReason::saturated));
  EXPECT_EQ(image.reason(6, 6), static_cast<int>(InvalidReason::no_return));
  EXPECT_TRUE(std::isnan(image.range_m(4, 4)));
  EXPECT_EQ(image.count_valid(), 16 * 24 - 3);
  walls.sensor.saturation_amplitude = 0;
  EXPECT_EQ(unwrap(walls.frame, walls.sensor, {}).image.count_valid(), 16 * 24 - 1);
}

TEST(Unwrapping, TakesImagesOfAnyShape) {
  struct Shape {
    Eigen::Index rows;
    Eigen::Index cols;
  };
  for (const auto& [rows, cols] : {Shape{1, 1}, {1, 9}, {9, 1}, {2, 2}, {16, 3}, {3, 20}}) {
    TwoWalls walls = two_walls(7, 7);
    for (ImageF* phase : {&walls.frame.phases[0], &walls.frame.phases[1]}) {
      *phase = ImageF(phase->topLeftCorner(rows, cols));
    }
    for (const char* method : {"none", "pixel", "single", "paper", "jump", "joint"}) {
      UnwrapOptions options;
      options.method = find_named<UnwrapMethod>(method).value();
      const RangeImage image = unwrap(walls.frame, walls.sensor, options).image;
      EXPECT_EQ(image.count_valid(), rows * cols) << method;
      const bool knows_count = method == std::string("pixel") || method == std::string("jump") ||
                               method == std::string("joint");
      if (!knows_count) continue;
      EXPECT_LT((image.range_m - 7).abs().maxCoeff(), 0.1) << method;
    }
  }
}

TEST(Unwrapping, OfAnImageWithoutAnyReturnIsEmpty) {
  TwoWalls walls = two_walls(3, 9);
  walls.frame.phases[0].setConstant(NAN);
  for (const char* method : {"none", "pixel", "single", "paper", "jump", "joint"}) {
    UnwrapOptions options;
    options.method = find_named<UnwrapMethod>(method).value();
    EXPECT_EQ(unwrap(walls.frame, walls.sensor, options).image.count_valid(), 0) << method;
  }
}

}  // namespace
}  // namespace tofmap

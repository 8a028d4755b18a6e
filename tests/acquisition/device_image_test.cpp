// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <tofmap/acquisition/device_image.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

SensorModel sensor(int width_px = 40, int height_px = 30) {
  SensorModel sensor;
  sensor.camera = pinhole_camera(1.2, width_px, height_px);
  sensor.camera.distortion = {-0.1, 0.02, 0.001, -0.002, 0};
  sensor.modulation = {29e6, 31e6};
  sensor.max_range_m = 12.5;
  sensor.saturation_amplitude = 50000;
  return sensor;
}

ImageF random_phase(const CameraModel& camera, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> phases(0, 1);
  ImageF phase = ImageF::NullaryExpr(camera.height_px, camera.width_px, [&] {
    return std::min(phases(random), std::nextafter(1.0F, 0.0F));
  });
  phase(1, 2) = NAN;
  phase(3, 4) = 0;
  phase(5, 6) = std::nextafter(1.0F, 0.0F);
  return phase;
}

Frame random_frame(const CameraModel& camera) {
  Frame frame = blank_frame(2);
  frame.timestamp_s = 12.25;
  frame.phases[0] = random_phase(camera, 1);
  frame.phases[1] = random_phase(camera, 2);
  frame.amplitudes[0] = 1000 * random_phase(camera, 3).isNaN().select(0, random_phase(camera, 3));
  frame.amplitudes[1] = 30000 * random_phase(camera, 4).isNaN().select(0, random_phase(camera, 4));
  return frame;
}

/// How far apart two phases are as ranges, the shorter way round.
float difference_m(float one, float other, double wavelength_m) {
  const double cycles = double{one} - double{other};
  return static_cast<float>(wavelength_m * std::abs(cycles - std::round(cycles)));
}

class EveryScale : public testing::TestWithParam<RangeScale> {};

TEST_P(EveryScale, KeepsRangesWithinHalfAStep) {
  const SensorModel model = sensor();
  const DeviceImageCodec codec(model, GetParam());
  const Frame frame = random_frame(model.camera);
  const StackedImages images = codec.stack(frame, 7);
  const Frame back = codec.unstack(images.range, images.amplitude);
  const ImageF ray_z = pixel_rays(model.camera).z;
  for (Eigen::Index i = 0; i < frame.phases[0].size(); ++i) {
    const float a = frame.phases[0].data()[i];
    ASSERT_EQ(std::isnan(a), std::isnan(back.phases[0].data()[i]));
    if (std::isnan(a)) continue;
    EXPECT_GE(back.phases[0].data()[i], 0);
    EXPECT_LT(back.phases[0].data()[i], 1);
    // A step along the axis is longer along the ray; floats hold a phase within 6e-8 cycles.
    const double along_ray = GetParam().is_z_depth ? ray_z.data()[i] : 1.0;
    const double bound_m = 0.5 * GetParam().unit_m / along_ray + 1e-6;
    const double wavelength_m = model.modulation.wavelength_m(0);
    EXPECT_LE(difference_m(a, back.phases[0].data()[i], wavelength_m), bound_m) << a;
  }
  EXPECT_LE((back.amplitudes[0] - frame.amplitudes[0]).abs().maxCoeff(), 1);
  EXPECT_LE((back.amplitudes[1] - frame.amplitudes[1]).abs().maxCoeff(), 0.5F);
}

INSTANTIATE_TEST_SUITE_P(DeviceImage, EveryScale,
                         testing::Values(RangeScale{1e-4, false}, RangeScale{1e-3, false},
                                         RangeScale{1e-4, true}),
                         [](const auto& test) {
                           return std::string(test.param.is_z_depth ? "z" : "radial") +
                                  std::to_string(static_cast<int>(1e6 * test.param.unit_m)) + "um";
                         });

TEST(DeviceImageCodec, RefusesUnitsThatDoNotHoldAWavelength) {
  SensorModel low = sensor();
  low.modulation = {10e6, 12e6};  // 15 m
  EXPECT_THROW(DeviceImageCodec(low, {1e-4, false}), UsageError);
  EXPECT_NO_THROW(DeviceImageCodec(low, {1e-3, false}));
}

TEST(DeviceImageCodec, TakesWhatIsLongerThanAWavelengthForNoReturn) {
  const SensorModel model = sensor();
  const DeviceImageCodec codec(model, {});
  const auto longest = static_cast<std::uint16_t>(1e4 * model.modulation.wavelength_m(1));
  ImageU16 range = ImageU16::Constant(30, 40, longest);
  range(3, 4) = longest + 2;
  EXPECT_EQ(codec.count_beyond(range, model.modulation.wavelength_m(1)), 1);
  EXPECT_EQ(codec.count_beyond(range, model.modulation.wavelength_m(0)), 0);
  const ImageF phase = codec.decode_range(range, model.modulation.wavelength_m(1));
  EXPECT_EQ(phase.isNaN().count(), 1);
}

TEST(DeviceImageCodec, RefusesImagesOfAnotherSize) {
  const DeviceImageCodec codec(sensor(), {});
  EXPECT_THROW(codec.unstack(ImageU16::Zero(61, 41), {}), UsageError);
  EXPECT_THROW(codec.unstack(ImageU16::Zero(60, 40), ImageU16::Zero(59, 40)), UsageError);
  EXPECT_THROW(codec.decode_range(ImageU16::Zero(31, 40), 5), UsageError);
  EXPECT_NO_THROW(codec.unstack(ImageU16::Zero(60, 40), {}));
}

TEST(FrameTag, SaysAllThatIsFixed) {
  for (const int width_px : {8, 40, 400}) {  // over several rows, and in one
    const SensorModel model = sensor(width_px);
    const DeviceImageCodec codec(model, {1e-3, true});
    const StackedImages images = codec.stack(random_frame(model.camera), 4'000'000'000U);
    for (const ImageU16* image : {&images.range, &images.amplitude}) {
      const auto tag = read_tag(*image);
      ASSERT_TRUE(tag) << width_px;
      EXPECT_EQ(tag->number, 4'000'000'000U);
      EXPECT_EQ(tag->timestamp_s, 12.25);
      EXPECT_EQ(tag->sensor.camera.width_px, width_px);
      EXPECT_EQ(tag->sensor.camera.height_px, 30);
      EXPECT_EQ(tag->sensor.camera.fx_px, model.camera.fx_px);
      EXPECT_EQ(tag->sensor.camera.cy_px, model.camera.cy_px);
      EXPECT_EQ(tag->sensor.camera.distortion, model.camera.distortion);
      EXPECT_EQ(tag->sensor.modulation.frequencies_hz[1], 31e6);
      EXPECT_EQ(tag->sensor.max_range_m, 12.5);
      EXPECT_EQ(tag->sensor.saturation_amplitude, 50000);
      EXPECT_EQ(tag->scale.unit_m, 1e-3);
      EXPECT_TRUE(tag->scale.is_z_depth);
    }
  }
}

TEST(FrameTag, HoldsNoPixelsThatOniFilesLose) {
  const SensorModel model = sensor();
  const DeviceImageCodec codec(model, {});
  Frame frame = random_frame(model.camera);
  frame.timestamp_s = 4 - 1e-15;  // most of its bits are ones, so words of 16 would be 65535
  const StackedImages images = codec.stack(frame, 0xffffffff);
  const Eigen::Index rows = tag_rows(model.camera.width_px, 2);
  EXPECT_LE(images.range.bottomRows(rows).maxCoeff(), 255);
  EXPECT_EQ(read_tag(images.range)->timestamp_s, frame.timestamp_s);
  EXPECT_EQ(read_tag(images.range)->number, 0xffffffff);
}

TEST(FrameTag, IsNotReadWhereItIsDamagedOrMissing) {
  const SensorModel model = sensor();
  StackedImages images = DeviceImageCodec(model, {}).stack(random_frame(model.camera), 1);
  const Eigen::Index first = images.range.rows() - tag_rows(40, 2);
  for (int column = 0; column < 40; ++column) {
    ImageU16 damaged = images.range;
    damaged(first, column) ^= 4;
    EXPECT_FALSE(read_tag(damaged)) << column;
  }
  EXPECT_FALSE(read_tag(images.range.topRows(60)));
  EXPECT_FALSE(read_tag(ImageU16()));
  EXPECT_FALSE(read_tag(ImageU16::Zero(1, 3)));
}

TEST(DeviceImage, HoldsAnyNumberOfFrequencies) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}, std::size_t{8}}) {
    SensorModel model = sensor(60, 40);
    model.modulation = {};
    Frame frame;
    frame.timestamp_s = 3.5;
    for (std::size_t f = 0; f < count; ++f) {
      model.modulation.frequencies_hz.push_back(80e6 - 7e6 * static_cast<double>(f));
      frame.phases.push_back(random_phase(model.camera, static_cast<unsigned>(f)));
    }
    const DeviceImageCodec codec(model, {});
    const StackedImages images = codec.stack(frame, 9);
    const std::optional<FrameTag> tag = read_tag(images.range);
    ASSERT_TRUE(tag) << count;
    EXPECT_EQ(tag->number, 9U);
    EXPECT_EQ(tag->sensor.modulation, model.modulation);
    const Frame read = codec.unstack(images.range, {});
    ASSERT_EQ(read.frequencies(), count);
    for (std::size_t f = 0; f < count; ++f) {
      const double wavelength_m = model.modulation.wavelength_m(f);
      for (Eigen::Index i = 0; i < read.phases[f].size(); ++i) {
        const float expected = frame.phases[f].data()[i];
        ASSERT_EQ(std::isnan(read.phases[f].data()[i]), std::isnan(expected));
        if (std::isnan(expected)) continue;
        ASSERT_LT(difference_m(read.phases[f].data()[i], expected, wavelength_m), 1e-4F);
      }
    }
  }
}

}  // namespace
}  // namespace tofmap

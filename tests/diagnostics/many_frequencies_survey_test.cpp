// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/diagnostics/copied_images.hpp>
#include <tofmap/diagnostics/residual_survey.hpp>
#include <tofmap/simulation/scenes.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Frames of a camera with three frequencies, and its model.
struct ThreeFrequencies {
  SensorModel sensor;
  std::vector<Frame> frames;

  explicit ThreeFrequencies(const char* scene) {
    SimulatorOptions options;
    options.width_px = 88;
    options.height_px = 72;
    options.subpixels = 1;
    options.frames = 6;
    options.frequencies_hz = {80e6, 16e6, 120e6};
    const Simulator simulator(make_scene(scene), options);
    sensor = simulator.sensor();
    for (int i = 0; i < options.frames; ++i) frames.push_back(simulator.simulate(i).frame);
  }

  std::vector<std::string> pairing_warnings() const {
    std::vector<std::string> warnings;
    for (const ResidualSurvey& residual : survey_residuals(frames, sensor)) {
      if (auto warning = pairing_warning(residual)) warnings.push_back(*std::move(warning));
    }
    return warnings;
  }
};

class ExchangedFrequencies : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Scenes, ExchangedFrequencies, testing::Values("room", "hall", "corridor"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST_P(ExchangedFrequencies, AreFoundAmongThoseThatAreNotTheFirst) {
  ThreeFrequencies camera(GetParam());
  EXPECT_THAT(camera.pairing_warnings(), IsEmpty());
  std::swap(camera.sensor.modulation.frequencies_hz[1], camera.sensor.modulation.frequencies_hz[2]);
  const std::vector<std::string> warnings = camera.pairing_warnings();
  ASSERT_FALSE(warnings.empty());
  EXPECT_THAT(warnings.front(), HasSubstr("B and C agree with A only if they are exchanged"));
}

TEST(CopiedImages, AreNamed) {
  ThreeFrequencies camera("room");
  EXPECT_FALSE(copied_images_warning(camera.frames));
  for (Frame& frame : camera.frames) frame.phases[2] = frame.phases[1];
  EXPECT_THAT(copied_images_warning(camera.frames).value_or(""),
              HasSubstr("B and C have the same phase images"));
}

TEST(CopiedImages, OfASingleFrameAreNotSeen) {
  ThreeFrequencies camera("room");
  camera.frames[0].phases[2] = camera.frames[0].phases[1];
  EXPECT_FALSE(copied_images_warning(camera.frames));
  EXPECT_FALSE(copied_images_warning({}));
}

}  // namespace
}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <utility>

#include <gtest/gtest.h>

#include <tofmap/diagnostics/swapped_amplitude.hpp>
#include <tofmap/simulation/scenes.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

std::vector<Frame> frames_of(const char* scene, double range_noise_m) {
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.subpixels = 1;
  options.frames = 6;
  options.range_noise_m = range_noise_m;
  const Simulator simulator(make_scene(scene), options);
  std::vector<Frame> frames;
  for (int i = 0; i < options.frames; ++i) frames.push_back(simulator.simulate(i).frame);
  return frames;
}

class SwappedAmplitude : public testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(SwappedAmplitude, IsToldFromPhases) {
  std::vector<Frame> frames = frames_of(GetParam().first, GetParam().second);
  EXPECT_FALSE(looks_like_swapped_amplitude(frames));
  for (Frame& frame : frames) {
    std::swap(frame.phases[0], frame.amplitudes[0]);
    std::swap(frame.phases[1], frame.amplitudes[1]);
  }
  EXPECT_TRUE(looks_like_swapped_amplitude(frames));
}

INSTANTIATE_TEST_SUITE_P(Scenes, SwappedAmplitude,
                         testing::Values(std::pair{"room", 0.01}, std::pair{"room", 0.1},
                                         std::pair{"hall", 0.03}, std::pair{"atrium", 0.03}));

TEST(SwappedAmplitudeOfNothing, IsNotSeen) { EXPECT_FALSE(looks_like_swapped_amplitude({})); }

TEST(SwappedAmplitudeOfNothing, NeedsAmplitudes) {
  std::vector<Frame> frames = frames_of("room", 0.01);
  for (Frame& frame : frames) {
    frame.amplitudes[0].resize(0, 0);
    frame.amplitudes[1].resize(0, 0);
  }
  EXPECT_FALSE(looks_like_swapped_amplitude(frames));
}

}  // namespace
}  // namespace tofmap

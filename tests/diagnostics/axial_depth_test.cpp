// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <tofmap/diagnostics/axial_depth.hpp>
#include <tofmap/simulation/scenes.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

class AxialDepth : public testing::TestWithParam<const char*> {};

TEST_P(AxialDepth, IsToldFromRanges) {
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.subpixels = 1;
  options.frames = 12;
  const Simulator simulator(make_scene(GetParam()), options);
  std::vector<Frame> frames;
  for (int i = 0; i < options.frames; ++i) frames.push_back(simulator.simulate(i).frame);
  EXPECT_FALSE(looks_like_axial_depth(frames, simulator.sensor()));
  const ImageF cosine = pixel_rays(simulator.sensor().camera).z;
  for (Frame& frame : frames) {
    frame.phases[0] *= cosine;
    frame.phases[1] *= cosine;
  }
  EXPECT_TRUE(looks_like_axial_depth(frames, simulator.sensor()));
}

INSTANTIATE_TEST_SUITE_P(Scenes, AxialDepth, testing::Values("room", "hall", "atrium"),
                         [](const auto& scene) { return scene.param; });

TEST(AxialDepthOfNothing, IsNotSeen) { EXPECT_FALSE(looks_like_axial_depth({}, {})); }

}  // namespace
}  // namespace tofmap

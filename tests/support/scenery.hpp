// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap::test {

/// A furnished scene: of an empty box every corner looks like every other.
class Scenery {
 public:
  explicit Scenery(const std::string& scene) : simulator_(make_scene(scene, 1), options()) {}

  const CameraModel& camera() const { return simulator_.sensor().camera; }

  Pose pose(int frame) const { return simulator_.simulate(frame).world_from_camera; }

  /// The true surfaces of a frame.
  std::shared_ptr<const SurfaceCloud> view(int frame) const {
    const SimulatedFrame simulated = simulator_.simulate(frame);
    RangeImage image(simulated.range_truth_m.rows(), simulated.range_truth_m.cols());
    image.range_m = simulated.range_truth_m;
    image.sigma_m.setConstant(0.01F);
    image.confidence.setConstant(1);
    image.wrap_count.setZero();
    image.reason = image.range_m.isNaN().cast<std::uint8_t>();
    return std::make_shared<const SurfaceCloud>(surface_cloud(image, pixel_rays(camera()), {}));
  }

 private:
  static SimulatorOptions options() {
    SimulatorOptions options;
    options.width_px = 88;
    options.height_px = 72;
    return options;
  }

  Simulator simulator_;
};

}  // namespace tofmap::test

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "box_ranges.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
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

  /// The true surfaces of a frame, with one more thing in the room if there is a `box`, in the
  /// world's frame.
  std::shared_ptr<const SurfaceCloud> view(int frame,
                                           std::optional<Eigen::AlignedBox3d> box = {}) const {
    const SimulatedFrame simulated = simulator_.simulate(frame);
    RangeImage image(simulated.range_truth_m.rows(), simulated.range_truth_m.cols());
    image.range_m = simulated.range_truth_m;
    if (box) put_into(image, *box, simulated.world_from_camera);
    image.sigma_m.setConstant(0.01F);
    image.confidence.setConstant(1);
    image.wrap_count.setZero();
    image.reason = image.range_m.isNaN().cast<std::uint8_t>();
    return std::make_shared<const SurfaceCloud>(surface_cloud(image, pixel_rays(camera()), {}));
  }

 private:
  void put_into(RangeImage& image, const Eigen::AlignedBox3d& box, const Pose& pose) const {
    for (int v = 0; v < camera().height_px; ++v) {
      for (int u = 0; u < camera().width_px; ++u) {
        const Eigen::Vector3d ray = pose.linear() * pixel_ray(camera(), u, v);
        const auto range_m = range_to(box, pose.translation(), ray);
        if (!range_m || *range_m > image.range_m(v, u)) continue;
        image.range_m(v, u) = static_cast<float>(*range_m);
      }
    }
  }

  static SimulatorOptions options() {
    SimulatorOptions options;
    options.width_px = 88;
    options.height_px = 72;
    return options;
  }

  Simulator simulator_;
};

}  // namespace tofmap::test

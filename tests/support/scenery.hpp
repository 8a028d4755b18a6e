// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "box_ranges.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
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

  Pose pose(int frame) const { return seen(frame).world_from_camera; }

  /// The true surfaces of a frame, with one more thing in the room if there is a `box`, in the
  /// world's frame.
  std::shared_ptr<const SurfaceCloud> view(int frame,
                                           std::optional<Eigen::AlignedBox3d> box = {}) const {
    const Seen& truth = seen(frame);
    RangeImage image(truth.range_m.rows(), truth.range_m.cols());
    image.range_m = truth.range_m;
    if (box) put_into(image, *box, truth.world_from_camera);
    image.sigma_m.setConstant(0.01F);
    image.confidence.setConstant(1);
    image.wrap_count.setZero();
    image.reason = image.range_m.isNaN().cast<std::uint8_t>();
    return std::make_shared<const SurfaceCloud>(surface_cloud(image, pixel_rays(camera()), {}));
  }

 private:
  struct Seen {
    Pose world_from_camera;
    ImageF range_m;
  };

  /// The true ranges of a frame. They are simulated once, since tests need most of them repeatedly.
  const Seen& seen(int frame) const {
    const auto known = seen_.find(frame);
    if (known != seen_.end()) return known->second;
    const SimulatedFrame simulated = simulator_.simulate(frame);
    return seen_.emplace(frame, Seen{simulated.world_from_camera, simulated.range_truth_m})
        .first->second;
  }

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
    options.subpixels = 1;  // true ranges are those of one ray a pixel anyway
    return options;
  }

  Simulator simulator_;
  mutable std::map<int, Seen> seen_;
};

}  // namespace tofmap::test

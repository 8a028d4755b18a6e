// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <tofmap/acquisition/simulator.hpp>
#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {
namespace {

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

TEST(PlaceDescriptor, TellsPlacesApart) {
  const Scenery room("room");
  const PlaceDescriptor here(*room.view(100));
  EXPECT_EQ(here.difference(here), 0);
  const double near = here.difference(PlaceDescriptor(*room.view(102)));
  const double far = here.difference(PlaceDescriptor(*room.view(180)));
  EXPECT_LT(near, 0.1);
  EXPECT_GT(far, 2 * near);
  EXPECT_EQ(here.difference(PlaceDescriptor(*room.view(180))),
            PlaceDescriptor(*room.view(180)).difference(here));
}

TEST(PlaceDescriptor, OfNothingIsLikeNothing) {
  const Scenery room("room");
  SurfaceCloud nothing = *room.view(100);
  for (SurfacePoint& point : nothing.points) point.normal_z = NAN;
  EXPECT_TRUE(std::isinf(PlaceDescriptor(nothing).difference(PlaceDescriptor(*room.view(100)))));
}

class LostCamera : public testing::Test {
 protected:
  static constexpr int first = 100;
  static constexpr int frames = 60;

  /// Follows the camera, covers it, and leaves it with few keyframes at hand, so that odometry
  /// cannot find places long ago by itself.
  LostCamera() : mapper_(room_.camera(), {.keyframes_around = 2}, {}, {}, {}) {
    for (int i = 0; i < frames; ++i) {
      EXPECT_TRUE(mapper_.track(i, i / 15.0, room_.view(first + i)).placed()) << i;
    }
    const auto nothing = std::make_shared<const SurfaceCloud>();
    for (int i = frames; i < frames + 5; ++i) {
      EXPECT_FALSE(mapper_.track(i, i / 15.0, nothing).placed());
    }
  }

  TrackingResult track(int number, const std::shared_ptr<const SurfaceCloud>& cloud) {
    return mapper_.track(number, number / 15.0, cloud);
  }

  Scenery room_{"room"};
  RoomMapper mapper_;
};

TEST_F(LostCamera, IsFoundWhereItWasLongBefore) {
  const int there = first + 6;
  const TrackingResult found = track(frames + 5, room_.view(there));
  ASSERT_EQ(found.status, TrackingStatus::relocalised);
  const Pose truth = room_.pose(first).inverse() * room_.pose(there);
  EXPECT_LT((truth.inverse() * found.world_from_camera).translation().norm(), 0.02);
  // From there on it is followed again.
  for (int i = 1; i < 10; ++i) {
    const TrackingResult next = track(frames + 5 + i, room_.view(there + i));
    ASSERT_EQ(next.status, TrackingStatus::tracked) << i;
  }
  EXPECT_EQ(mapper_.trajectory().size(), frames + 10U) << "frames in between are not placed";
}

TEST_F(LostCamera, IsNotFoundInAnotherBuilding) {
  const Scenery flat("flat");
  for (int i = 5; i < 10; ++i) EXPECT_FALSE(track(frames + i, flat.view(50 + i)).placed());
}

}  // namespace
}  // namespace tofmap

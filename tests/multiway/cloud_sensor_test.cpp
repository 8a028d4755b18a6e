// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>
#include <support/scans.hpp>

#include <tofmap/multiway/cloud_sensor.hpp>
#include <tofmap/simulation/scenes.hpp>

namespace tofmap {
namespace {

const Eigen::Vector3d origin = Eigen::Vector3d::Zero();

PointSet room_scan() {
  const Scene scene = make_scene("room");
  return test::scan(RayScene(scene.surface), scene.path.pose_at(0));
}

PointSet moved(const PointSet& cloud, const Eigen::Vector3d& by_m) {
  return test::moved(cloud, Pose(Eigen::Translation3d(by_m)));
}

PointSet with_limit(const PointSet& cloud) { return test::with_limit(cloud, 30, 2000); }

TEST(FindSensor, TakesTheOriginIfItIsGiven) {
  const CloudSensor sensor = find_sensor(moved(room_scan(), {5, 0, 0}), SensorAtOrigin::yes);
  EXPECT_EQ(sensor.source, SensorSource::given);
  EXPECT_EQ(sensor.position, origin);
}

TEST(FindSensor, InfersTheOriginOnlyIfThePointsWereSeenFromThere) {
  const CloudSensor own = find_sensor(room_scan(), SensorAtOrigin::infer);
  EXPECT_EQ(own.source, SensorSource::inferred);
  EXPECT_EQ(own.position, origin);
  const CloudSensor elsewhere = find_sensor(moved(room_scan(), {1, 0, 0}), SensorAtOrigin::infer);
  EXPECT_NE(elsewhere.position, origin);
}

TEST(FindSensor, TakesTheViewpointOfTheFileUnlessThePointsContradictIt) {
  const Eigen::Vector3d stood_m(3, 1, -1);
  PointSet cloud = moved(room_scan(), stood_m);
  cloud.viewpoint = stood_m;
  const CloudSensor sensor = find_sensor(cloud, SensorAtOrigin::infer);
  EXPECT_EQ(sensor.source, SensorSource::stated);
  EXPECT_EQ(sensor.position, stood_m);
  cloud.viewpoint = stood_m + Eigen::Vector3d(1.5, -0.5, 0.4);
  EXPECT_NE(find_sensor(cloud, SensorAtOrigin::infer).source, SensorSource::stated);
}

TEST(FindSensor, FindsTheCentreOfALimitOfRange) {
  const Eigen::Vector3d stood_m(3, 1, -1);
  const PointSet plain = moved(room_scan(), stood_m);
  PointSet cloud = moved(with_limit(room_scan()), stood_m);
  leave_out_range_limit(cloud, SensorAtOrigin::no);
  EXPECT_EQ(cloud.points, plain.points);
  ASSERT_TRUE(cloud.limit);
  EXPECT_EQ(cloud.limit->points, 2000U);
  const CloudSensor sensor = find_sensor(cloud, SensorAtOrigin::no);
  EXPECT_EQ(sensor.source, SensorSource::range_limit);
  ASSERT_TRUE(sensor.position);
  EXPECT_LT((*sensor.position - stood_m).norm(), 0.01);
}

TEST(LeaveOutRangeLimit, LooksOnlyAboutTheOriginIfThatIsTheSensor) {
  PointSet cloud = moved(with_limit(room_scan()), {3, 1, -1});
  const std::size_t all = cloud.points.size();
  leave_out_range_limit(cloud, SensorAtOrigin::yes);
  EXPECT_FALSE(cloud.limit);
  EXPECT_EQ(cloud.points.size(), all);
}

TEST(LeaveOutRangeLimit, LeavesACloudWithoutALimitAsItIs) {
  PointSet cloud = room_scan();
  const std::vector<Eigen::Vector3d> points = cloud.points;
  leave_out_range_limit(cloud, SensorAtOrigin::infer);
  EXPECT_FALSE(cloud.limit);
  EXPECT_EQ(cloud.points, points);
}

}  // namespace
}  // namespace tofmap

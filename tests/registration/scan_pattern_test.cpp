// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>
#include <support/scans.hpp>

#include <tofmap/cloud/downsample.hpp>
#include <tofmap/registration/scan_pattern.hpp>
#include <tofmap/simulation/scenes.hpp>

namespace tofmap {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// A scan of a furnished room in the frame of its sensor.
Points room_scan(double at_s = 0) {
  const Scene scene = make_scene("room");
  return test::scan(RayScene(scene.surface), scene.path.pose_at(at_s)).points;
}

Points moved(Points points, const Eigen::Vector3d& by_m) {
  for (Eigen::Vector3d& point : points) point += by_m;
  return points;
}

TEST(ScanPattern, IsEvidenceForTheSensorAlone) {
  const Points points = room_scan();
  const ScanPattern here = scan_pattern(points, Eigen::Vector3d::Zero());
  EXPECT_TRUE(here.is_evidence_for());
  EXPECT_FALSE(here.is_evidence_against());
  for (const Eigen::Vector3d& elsewhere : {Eigen::Vector3d(0.7, 0, 0), Eigen::Vector3d(0, 0, -1)}) {
    EXPECT_FALSE(scan_pattern(points, elsewhere).is_evidence_for()) << elsewhere.transpose();
  }
}

TEST(ScanPattern, IsEvidenceAgainstAPlaceBeyondTheSurfaces) {
  const Eigen::Vector3d sensor_m(1.5, -0.5, 0.4);
  const Points points = moved(room_scan(), sensor_m);
  EXPECT_TRUE(scan_pattern(points, Eigen::Vector3d::Zero()).is_evidence_against());
  EXPECT_FALSE(scan_pattern(points, sensor_m).is_evidence_against());
}

TEST(ScanPattern, IsNoEvidenceForAMergedCloud) {
  const Points other = moved(room_scan(2), {0.8, 0.3, 0});
  Points merged = room_scan();
  merged.insert(merged.end(), other.begin(), other.end());
  EXPECT_FALSE(scan_pattern(merged, Eigen::Vector3d::Zero()).is_evidence_for());
}

TEST(ScanPattern, SaysNothingOfTooFewPoints) {
  Points few = room_scan();
  few.resize(100);
  const ScanPattern pattern = scan_pattern(few, Eigen::Vector3d::Zero());
  EXPECT_FALSE(pattern.is_evidence_for());
  EXPECT_FALSE(pattern.is_evidence_against());
  EXPECT_FALSE(scan_pattern({}, Eigen::Vector3d::Zero()).is_evidence_for());
}

}  // namespace
}  // namespace tofmap

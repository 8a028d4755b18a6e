// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cloud_graph.hpp"
#include "cloud_units.hpp"

#include <gtest/gtest.h>
#include <omp.h>
#include <support/scans.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/multiway/cloud_registration.hpp>
#include <tofmap/simulation/scenes.hpp>

namespace tofmap {
namespace {

/// Scans along the first part of a scene's path, and where they were taken.
struct Scans {
  std::vector<PointSet> clouds;
  std::vector<Pose> poses;
  std::vector<std::string> names;
};

Scans scans_of(const std::string& scene_name, std::vector<double> shares) {
  const Scene scene = make_scene(scene_name);
  const RayScene rays(scene.surface);
  Scans scans;
  for (const double share : shares) {
    scans.poses.push_back(scene.path.pose_at(share * scene.path.end()));
    scans.names.push_back(scene_name + std::to_string(share));
    scans.clouds.push_back(
        test::scan(rays, scans.poses.back(), static_cast<unsigned>(scans.names.size())));
  }
  return scans;
}

/// The largest distance of a registered cloud's point, three metres before its sensor, from where
/// it should be.
double largest_error_m(const CloudRegistration& found, const std::vector<Pose>& poses) {
  const auto first = static_cast<std::size_t>(
      std::ranges::find_if(found.clouds, &RegisteredCloud::is_registered) - found.clouds.begin());
  double largest = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!found.clouds[i].is_registered) continue;
    const Eigen::Vector3d ahead(0, 0, 3);
    const Eigen::Vector3d truth = poses[first].inverse() * poses[i] * ahead;
    largest = std::max(largest, (found.clouds[i].common_from_cloud * ahead - truth).norm());
  }
  return largest;
}

TEST(RegisterClouds, PlacesScansOfOneRoomInAnyOrder) {
  const Scans scans = scans_of("room", {0.2, 0, 0.3, 0.1});
  const CloudRegistration found = register_clouds(scans.clouds, scans.names, {});
  EXPECT_EQ(found.registered(), 4);
  EXPECT_LT(largest_error_m(found, scans.poses), 0.02);
  EXPECT_TRUE(found.clouds[0].common_from_cloud.isApprox(Pose::Identity()));
  EXPECT_FALSE(found.clouds[0].tied_to.empty());
  EXPECT_EQ(found.pairs.size(), 6U);
}

TEST(RegisterClouds, PlacesScansOfFewPoints) {
  Scans scans = scans_of("room", {0, 0.05});
  const auto thin_out = [](PointSet& cloud, std::size_t step) {
    for (std::size_t i = 0; i * step < cloud.points.size(); ++i) {
      cloud.points[i] = cloud.points[i * step];
    }
    cloud.points.resize((cloud.points.size() + step - 1) / step);
  };
  thin_out(scans.clouds[0], 3);
  thin_out(scans.clouds[1], 7);  // 3600 points, and 8400
  const CloudRegistration found = register_clouds(scans.clouds, scans.names, {});
  EXPECT_EQ(found.registered(), 2);
  EXPECT_LT(largest_error_m(found, scans.poses), 0.05);
}

TEST(RegisterClouds, NamesACloudOfAnotherPlaceAndLeavesItOut) {
  Scans scans = scans_of("room", {0, 0.1});
  const Scans other = scans_of("hall", {0});
  scans.clouds.push_back(other.clouds[0]);
  scans.names.push_back(other.names[0]);
  const CloudRegistration found = register_clouds(scans.clouds, scans.names, {});
  EXPECT_EQ(found.registered(), 2);
  EXPECT_FALSE(found.clouds[2].is_registered);
  EXPECT_NE(found.clouds[2].remark.find("fits no other cloud"), std::string::npos);
}

TEST(RegisterClouds, NoticesMillimetresAndConvertsThemOnWish) {
  Scans scans = scans_of("room", {0, 0.1});
  scans.clouds[0] = test::scaled(scans.clouds[0], 1000);
  CloudRegistrationOptions options;
  const CloudRegistration refused = register_clouds(scans.clouds, scans.names, options);
  EXPECT_EQ(refused.registered(), 0);
  EXPECT_NE(refused.clouds[0].remark.find("millimetres"), std::string::npos);
  options.convert_units = true;
  const CloudRegistration found = register_clouds(scans.clouds, scans.names, options);
  EXPECT_EQ(found.registered(), 2);
  EXPECT_EQ(found.clouds[0].unit_m, 0.001);
  EXPECT_LT(largest_error_m(found, scans.poses), 0.02);
}

TEST(RegisterClouds, DoesNotBelieveAPoseThatAWallLeavesOpen) {
  std::vector<PointSet> walls(2);
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 80; ++j) {
      walls[0].points.emplace_back(0.05 * i, 0.05 * j, 3);
      walls[1].points.emplace_back(0.05 * i + 1, 0.05 * j, 3);
    }
  }
  const std::vector<std::string> names{"a", "b"};
  EXPECT_EQ(register_clouds(walls, names, {}).registered(), 0);
}

TEST(RegisterClouds, GivesTheSameBitsForAnyNumberOfThreads) {
  const Scans scans = scans_of("room", {0, 0.1, 0.2});
  const int threads = omp_get_max_threads();
  std::vector<CloudRegistration> found;
  for (const int count : {1, 3}) {
    omp_set_num_threads(count);
    found.push_back(register_clouds(scans.clouds, scans.names, {}));
  }
  omp_set_num_threads(threads);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found[0].clouds[i].common_from_cloud.matrix(),
              found[1].clouds[i].common_from_cloud.matrix());
  }
}

TEST(RegisterClouds, EndsWhenAskedTo) {
  const Scans scans = scans_of("room", {0, 0.1, 0.2});
  const auto stop = [](int, int) { return false; };
  const CloudRegistration found = register_clouds(scans.clouds, scans.names, {}, stop);
  EXPECT_TRUE(found.interrupted);
  EXPECT_EQ(found.registered(), 0);
}

TEST(RegisterClouds, WantsTwoClouds) {
  const Scans scans = scans_of("room", {0});
  EXPECT_THROW(register_clouds(scans.clouds, scans.names, {}), UsageError);
}

TEST(RegisterClouds, NamesACloudWithTooFewPoints) {
  const Scans scans = scans_of("room", {0});
  std::vector<PointSet> clouds = scans.clouds;
  clouds.push_back({{{1, 2, 3}, {1, 2, 4}}, {}});
  const std::vector<std::string> names{"room", "crumbs"};
  const CloudRegistration found = register_clouds(clouds, names, {});
  EXPECT_EQ(found.registered(), 0);
  EXPECT_NE(found.clouds[1].remark.find("too few points"), std::string::npos);
}

CloudPair edge(int source, int target, const Pose& target_from_source) {
  CloudPair pair;
  pair.source = source;
  pair.target = target;
  pair.verdict = PairVerdict::registered;
  pair.target_from_source = target_from_source;
  pair.covariance = 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();
  pair.fit = {0.9, 0.9, 0.01};
  return pair;
}

Pose along_x(double x_m) { return test::moved_by({0, 0, 0}, {x_m, 0, 0}); }

TEST(FitGraph, TakesTheirSayFromPairsThatOthersContradict) {
  // Four clouds a metre apart, all pairs measured, one of them wrongly.
  std::vector<CloudPair> pairs;
  for (int source = 1; source < 4; ++source) {
    for (int target = 0; target < source; ++target) {
      const bool is_wrong = source == 3 && target == 0;
      pairs.push_back(edge(source, target, along_x(is_wrong ? 5 : source - target)));
      if (is_wrong) pairs.back().fit.overlap = 1;  // however well it looks
    }
  }
  const auto poses = fit_graph(4, pairs, 0.01, 3);
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(poses[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(poses[static_cast<std::size_t>(i)]->translation().x(), i, 0.01);
  }
  for (const CloudPair& pair : pairs) {
    const bool is_wrong = pair.source == 3 && pair.target == 0;
    EXPECT_EQ(pair.verdict, is_wrong ? PairVerdict::disagrees : PairVerdict::registered);
  }
}

TEST(FitGraph, PlacesTheLargestPartAlone) {
  std::vector<CloudPair> pairs{edge(1, 0, along_x(1)), edge(3, 2, along_x(1)),
                               edge(4, 2, along_x(2))};
  const auto poses = fit_graph(6, pairs, 0.01, 3);
  EXPECT_FALSE(poses[0] || poses[1] || poses[5]);
  ASSERT_TRUE(poses[2] && poses[3] && poses[4]);
  EXPECT_NEAR(poses[4]->translation().x(), 2, 1e-6);
}

TEST(FitGraph, PlacesNothingWithoutPairs) {
  std::vector<CloudPair> pairs;
  for (const auto& pose : fit_graph(3, pairs, 0.01, 3)) EXPECT_FALSE(pose);
}

TEST(LikelyUnits, AreThoseThatMakeSizesCommon) {
  const auto units = likely_units(110, 0.1);
  ASSERT_FALSE(units.empty());
  EXPECT_EQ(units[0].name, "millimetres");
  EXPECT_EQ(likely_units(0.33, 0.1)[0].name, "feet");
  EXPECT_TRUE(likely_units(0.15, 0.1).empty());
  EXPECT_TRUE(likely_units(1e9, 0.1).empty());
}

TEST(OfCommonSize, IsTheLargestGroup) {
  const std::vector<double> spacings{100, 0.1, 120, 90};
  EXPECT_EQ(of_common_size(spacings), (std::vector<bool>{true, false, true, true}));
  const std::vector<double> even{100, 0.1};
  EXPECT_EQ(of_common_size(even), (std::vector<bool>{false, true}));
}

}  // namespace
}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/rotation_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <tofmap/registration/spherical_view.hpp>

namespace tofmap {
namespace {

constexpr double step_rad = 4 * std::numbers::pi / 180;

/// Rotations closer together than this are one answer.
constexpr double apart_rad = 2 * step_rad;

/// Number of points that are compared along the longer side of the image.
constexpr std::size_t points_along_side = 28;

/// Smallest score of a rotation that is returned; 1 is a perfect fit of all points, and a random
/// one is below 0.
constexpr double least_score = 0.2;

/// From the axes of a camera to those of a panorama, whose poles are above and below the camera.
const Eigen::Matrix3d panorama_from_camera{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};

struct RangedPoint {
  Eigen::Vector3d camera_m;
  double log_range;
};

std::vector<RangedPoint> thinned(const SurfaceCloud& cloud) {
  const std::size_t side = std::max(cloud.width, cloud.height);
  const std::size_t stride = std::max<std::size_t>(1, side / points_along_side);
  std::vector<RangedPoint> points;
  for (std::size_t row = stride / 2; row < cloud.height; row += stride) {
    for (std::size_t col = stride / 2; col < cloud.width; col += stride) {
      const SurfacePoint& point = cloud.points[row * cloud.width + col];
      if (!point.has_normal()) continue;
      const Eigen::Vector3d place = point.getVector3fMap().cast<double>();
      points.push_back({place, std::log(place.norm())});
    }
  }
  return points;
}

/// What the keyframes saw, around the expected position and in the axes of panorama_from_camera.
SphericalView panorama(std::span<const Keyframe* const> keyframes, const Pose& expected) {
  std::vector<Eigen::Vector3f> points_m;
  for (const Keyframe* keyframe : keyframes) {
    const Pose camera_from_keyframe = expected.inverse() * keyframe->world_from_camera;
    const auto cloud = keyframe->cloud.load();
    for (const SurfacePoint& point : cloud->points) {
      if (!point.has_normal()) continue;
      const Eigen::Vector3d place = camera_from_keyframe * point.getVector3fMap().cast<double>();
      points_m.emplace_back((panorama_from_camera * place).cast<float>());
    }
  }
  return {points_m, Eigen::Vector3d::Zero()};
}

/// How well the ranges fit at a rotation: 1 for a point whose range is the same, −0.5 for one whose
/// range differs by more than a fifth, 0 for one in a direction that no keyframe saw; on average.
double score(const std::vector<RangedPoint>& points, const SphericalView& seen,
             const Eigen::Matrix3d& expected_from_camera) {
  constexpr double log_tolerance = 0.15;
  constexpr double worst = -0.5;
  const Eigen::Matrix3d panorama_from_points = panorama_from_camera * expected_from_camera;
  double sum = 0;
  for (const RangedPoint& point : points) {
    const std::optional<double> range_m = seen.range_m(panorama_from_points * point.camera_m);
    if (!range_m) continue;
    const double off = (std::log(*range_m) - point.log_range) / log_tolerance;
    sum += std::max(worst, 1 - off * off);
  }
  return sum / static_cast<double>(points.size());
}

struct ScoredRotation {
  Eigen::Matrix3d expected_from_camera = Eigen::Matrix3d::Identity();
  double score = 0;
};

/// Rotations by the vectors of a cubic grid, at most `reach_rad` long.
std::vector<ScoredRotation> rotations_within(double reach_rad) {
  const int steps = static_cast<int>(reach_rad / step_rad);
  std::vector<ScoredRotation> rotations;
  for (int x = -steps; x <= steps; ++x) {
    for (int y = -steps; y <= steps; ++y) {
      for (int z = -steps; z <= steps; ++z) {
        const Eigen::Vector3d vector_rad = step_rad * Eigen::Vector3d(x, y, z);
        const double angle_rad = vector_rad.norm();
        if (angle_rad > reach_rad) continue;
        // normalized() leaves a zero vector as it is; the angle is 0 then.
        rotations.push_back(
            {Eigen::AngleAxisd(angle_rad, vector_rad.normalized()).toRotationMatrix()});
      }
    }
  }
  return rotations;
}

double angle_rad(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle();
}

}  // namespace

std::vector<Pose> search_rotations(const SurfaceCloud& cloud,
                                   std::span<const Keyframe* const> keyframes, const Pose& expected,
                                   double reach_rad, std::size_t most) {
  const std::vector<RangedPoint> points = thinned(cloud);
  if (points.empty() || keyframes.empty()) return {};
  const SphericalView seen = panorama(keyframes, expected);
  std::vector<ScoredRotation> rotations = rotations_within(reach_rad);
  const int count = static_cast<int>(rotations.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) {
    rotations[i].score = score(points, seen, rotations[i].expected_from_camera);
  }
  std::erase_if(rotations, [](const ScoredRotation& one) { return one.score < least_score; });
  std::ranges::stable_sort(rotations, std::ranges::greater(), &ScoredRotation::score);
  std::vector<ScoredRotation> best;
  for (const ScoredRotation& one : rotations) {
    if (best.size() == most) break;
    const bool is_new = std::ranges::none_of(best, [&](const ScoredRotation& other) {
      return angle_rad(one.expected_from_camera, other.expected_from_camera) < apart_rad;
    });
    if (is_new) best.push_back(one);
  }
  std::vector<Pose> poses;
  for (const ScoredRotation& one : best) {
    Pose pose = expected;
    pose.linear() = expected.linear() * one.expected_from_camera;
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// The true surface as far as the camera saw it: points from true ranges and true poses, the first
/// in each voxel of 4 cm. Coordinates are stored relative to an origin in the world frame of the
/// true poses, so that floats are precise enough even if the world frame has large coordinates,
/// such as those of a national grid.
class ReferenceSurface {
 public:
  ReferenceSurface() = default;
  /// `origin_m` is a position in the world frame, see origin_near().
  explicit ReferenceSurface(const Eigen::Vector3d& origin_m) : origin_m_(origin_m) {}

  /// Adds the points of a frame, from every second pixel in both directions. `range_truth_m` holds
  /// radial ranges in metres; pixels that are not finite are ignored. `world_from_camera` is not
  /// relative to the origin.
  void add(const ImageF& range_truth_m, const PixelRays& rays, const Pose& world_from_camera);

  /// The origin of the points, in the world frame, metres.
  const Eigen::Vector3d& origin_m() const { return origin_m_; }

  /// The points relative to the origin, metres.
  const std::vector<Eigen::Vector3f>& points() const { return points_; }

  /// The distance of each point from the next points that its frame saw on the same surface,
  /// metres. It is large where the surface was far away or seen at a grazing angle.
  const std::vector<float>& spacings_m() const { return spacings_m_; }

 private:
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  std::unordered_map<std::int64_t, std::size_t> voxels_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<float> spacings_m_;
};

/// An origin for ReferenceSurface near the positions of a trajectory: the median of each
/// coordinate, rounded to whole metres, so that the voxels do not depend on a shift of the world
/// frame by whole metres. Zero if the trajectory is empty.
Eigen::Vector3d origin_near(const Trajectory& poses);

/// Map points with a larger error, metres, count as wrong (MapScore::far_percent).
inline constexpr double far_error_m = 0.2;

/// The errors of a map against the true surface.
struct MapScore {
  double accuracy_m = 0;            ///< mean of errors_m, each limited to 5 m
  double far_percent = 0;           ///< share of map points with an error above far_error_m
  double completeness_percent = 0;  ///< share of true points with a map point within 0.1 m
  std::vector<float> errors_m;      ///< map_errors_m() of each map point
};

/// The distance of each map point from the true surface, metres. `truth_from_map` transforms the
/// map into the world frame of the reference. Points closer than 0.1 m to their nearest reference
/// point, or closer than the reference is spaced there, get their distance from the plane through
/// its neighbours, so that the sampling of the reference does not count as error; other points get
/// the distance from that point. Errors above `most_m` are set to `most_m`, which saves the search
/// for far points. Throws UsageError if the reference is empty or `most_m` is not positive.
std::vector<float> map_errors_m(const MapCloud& map, const Pose& truth_from_map,
                                const ReferenceSurface& reference,
                                double most_m = std::numeric_limits<double>::infinity());

/// Scores a map against the true surface. `truth_from_map` transforms the map into the world frame
/// of the reference. The accuracy of an empty map is NaN. Throws UsageError if the reference is
/// empty.
MapScore score_map(const MapCloud& map, const Pose& truth_from_map,
                   const ReferenceSurface& reference);

}  // namespace tofmap

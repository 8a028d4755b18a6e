// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// Options of SurfaceMap, and of the map that RoomMapper makes of it.
struct SurfaceMapOptions {
  /// Edge length of a voxel, 0.002 … 10 m. Each voxel becomes at most one map point.
  double voxel_m = 0.04;
  /// Smallest number of observations of a voxel that becomes a map point, 1 … 100000.
  int min_observations = 3;
  /// Largest standard deviation along the normal of a point that enters the map, 0.001 … 100 m.
  double max_sigma_m = 0.1;
  /// Whether points that keyframes see through are removed from the map: moving objects, flying
  /// pixels, points with a wrong wrap count (without_free_space_violations()).
  bool drop_free_space_violations = true;

  bool operator==(const SurfaceMapOptions&) const = default;

  static std::vector<OptionField<SurfaceMapOptions>> fields();
};

/// The surface seen so far: one averaged point per voxel of a hash grid. Memory grows with the
/// surface seen, not with the number of frames.
///
/// Each voxel keeps the mean of its points and normals, weighted by confidence and by the inverse
/// variance of the points along their normals. The order of frames changes the result only by
/// rounding errors; the number of threads does not change it.
class SurfaceMap {
 public:
  explicit SurfaceMap(const SurfaceMapOptions& options);

  /// Adds the points of a cloud that have a normal. The cloud is in the frame of its camera. Points
  /// whose predicted standard deviation along the normal exceeds max_sigma_m are not added. Throws
  /// UsageError if a point is too far out for voxels of this size.
  void integrate(const SurfaceCloud& cloud, const Pose& world_from_camera);

  /// Adds the voxels of a submap with the same options, each as one point with the weight and the
  /// observations of the voxel. `recording` is the index of the recording that the submap is of.
  /// Throws UsageError as integrate() does.
  void add(const SurfaceMap& submap, const Pose& world_from_submap, int recording = 0);

  /// Number of voxels seen so far.
  std::size_t size() const { return voxels_.size(); }

  /// Points of the voxels with at least min_observations, in the order of x, then y, then z of the
  /// voxel. The confidence of a map point is the mean over its observations.
  MapCloud extract() const;

  /// Tells states of surfaces apart: every change gives a number that no surface had before in this
  /// process.
  std::uint64_t revision() const { return revision_; }

  /// All voxels, from which surface_from_bytes() makes the same surface to the bit.
  std::string to_bytes() const;

 private:
  friend SurfaceMap surface_from_bytes(std::string_view bytes, const SurfaceMapOptions& options);

  struct Voxel {
    Eigen::Vector3f weighted_offset_m = Eigen::Vector3f::Zero();  ///< from the voxel's centre
    Eigen::Vector3f weighted_normal = Eigen::Vector3f::Zero();
    float weight = 0;
    float confidence = 0;  ///< sum over the observations
    std::uint32_t observations = 0;
    std::uint32_t recording = 0;  ///< the first one of those that were added
  };

  std::int64_t key(const Eigen::Vector3d& point_m) const;
  Eigen::Vector3d centre_m(std::int64_t key) const;
  Eigen::Vector3d mean_m(std::int64_t key, const Voxel& voxel) const;

  void note_change();

  SurfaceMapOptions options_;
  std::uint64_t revision_ = 0;
  std::unordered_map<std::int64_t, Voxel> voxels_;
};

/// The surface whose bytes SurfaceMap::to_bytes() returned. The options must be the same. Throws
/// InputError if the bytes are damaged.
SurfaceMap surface_from_bytes(std::string_view bytes, const SurfaceMapOptions& options);

}  // namespace tofmap

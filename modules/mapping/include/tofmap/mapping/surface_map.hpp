// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/trajectory.hpp>

namespace boost::serialization {
class access;
}

namespace tofmap {

struct SurfaceMapOptions {
  double voxel_m = 0.04;
  int min_observations = 3;
  double max_sigma_m = 0.1;
  bool drop_free_space_violations = true;

  static std::vector<OptionField<SurfaceMapOptions>> fields();
};

/// The surface seen so far, one averaged point per voxel of a hash grid: memory follows the
/// volume seen, not the number of frames.
///
/// Each voxel keeps the mean of its points and normals, weighted by confidence and the inverse
/// variance of the points along their normals. The result depends on the order of frames only by
/// rounding, and on the number of threads not at all.
class SurfaceMap {
 public:
  explicit SurfaceMap(const SurfaceMapOptions& options);

  /// Adds the points with normals of a cloud in the camera's frame. Points whose predicted
  /// standard deviation along the normal exceeds max_sigma_m are left out.
  void integrate(const SurfaceCloud& cloud, const Pose& world_from_camera);

  /// Adds what another map of the same voxels holds, which is in a frame of its own. Its points
  /// keep their weight and their observations.
  void add(const SurfaceMap& part, const Pose& world_from_part);

  /// Voxels seen so far.
  std::size_t size() const { return voxels_.size(); }

  /// The voxels with at least min_observations, ordered by their place in the grid. Their
  /// confidence is the mean of their points' confidences.
  MapCloud extract() const;

 private:
  friend class boost::serialization::access;
  template <class Archive>
  void serialize(Archive& archive, unsigned version);  // mapper_archive.cpp

  struct Voxel {
    Eigen::Vector3d weighted_point_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d weighted_normal = Eigen::Vector3d::Zero();
    double weight = 0;
    double confidence = 0;
    std::uint32_t observations = 0;

    template <class Archive>
    void serialize(Archive& archive, unsigned version);
  };

  std::int64_t key(const Eigen::Vector3d& point_m) const;

  SurfaceMapOptions options_;
  std::unordered_map<std::int64_t, Voxel> voxels_;
};

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/pipeline/room_map.hpp>

namespace tofmap {

/// The frame of a recording that was found in a map.
struct LocalisedFrame {
  int index = 0;     ///< of the frame in the recording
  StampedPose pose;  ///< world_from_camera, in the world of the map
  /// Of the error of the pose relative to the map: rotation vector in radians, then translation in
  /// metres, along the axes of the world.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// A recording that was localised in a map.
struct Localisation {
  std::vector<LocalisedFrame> localised;  ///< those found in the map, in order
  std::vector<FrameRecord> frames;        ///< all frames, in order
  std::vector<MapChange> changes;         ///< what has changed since the map was made
  MapNearness nearness;
  bool interrupted = false;  ///< a hook ended the run early
};

}  // namespace tofmap

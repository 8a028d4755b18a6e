// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/mapping/surface_map.hpp>

namespace tofmap {

/// The points that belong to changes.
struct ChangedPoints {
  MapCloud points;
  std::vector<char>
      is_seed;  ///< for each point, whether it violates free space, and was there with certainty

  void add(const MapPoint& point, bool point_is_seed) {
    points.push_back(point);
    is_seed.push_back(point_is_seed ? 1 : 0);
  }
};

/// The points of changes that are a surface. Left out are those that the noise of ranges puts in
/// front of a surface, or behind it, and those around which points hardly have the observations
/// that a map demands and lie scattered: points of a surface lie side by side, however rarely it
/// was observed.
ChangedPoints without_noise(const ChangedPoints& changed, const SurfaceMapOptions& options);

}  // namespace tofmap

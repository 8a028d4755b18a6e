// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "levelled_cloud.hpp"

#include <span>

namespace tofmap {

/// What a cloud shows of the space that the sensor of another cloud saw, in numbers of points of
/// the coarsest level.
struct FreeSpaceEvidence {
  int on_surface = 0;     ///< where both clouds show the same surface
  int in_free_space = 0;  ///< in regions that the sensor saw through
  int in_windows = 0;     ///< in such regions that may be windows

  /// Share of free-space violations among all points that the sensor could see. 0 if there is too
  /// little evidence for a violation.
  double violation_share() const;

  /// Share of points that the sensor may have seen through windows. 0 if there are no points.
  double window_share() const;
};

/// Compares a cloud with what the sensor of another cloud saw.
///
/// A single point in free space (sights()) proves nothing: edges, moving leaves, mixed pixels and
/// averaging in voxels cause scattered ones. A point counts only if at least four of its neighbours
/// are in free space, and at least as many as are on a surface; neighbours are correlated, so
/// what counts is whole regions. Regions that may_be_window() are counted apart, unless they are
/// more than a tenth of all.
FreeSpaceEvidence free_space_evidence(const SphericalView& view, const LevelledCloud& cloud,
                                      const Pose& view_from_cloud);

/// The same for several places where the sensor may have been, one of each view: the evidence from
/// the place that explains the cloud best, with the least violation share. None without views.
FreeSpaceEvidence least_evidence(std::span<const SphericalView> views, const LevelledCloud& cloud,
                                 const Pose& view_from_cloud);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Geometry>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/named_value.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// What became of a thing between two recordings.
enum class ChangeKind {
  gone,      ///< it was there before
  appeared,  ///< it was not there before
  moved,     ///< it was elsewhere before
};

/// The names of all kinds; `appeared` is called "new".
std::span<const NamedValue<ChangeKind>> named_values(ChangeKind);

/// A surface that changed between recordings: points of a map that are connected.
struct MapChange {
  int map = 0;  ///< Keyframe::map of the map that has changed
  ChangeKind kind = ChangeKind::gone;
  int recording = 0;  ///< index of the recording that shows the change, at least 1
  MapCloud before;    ///< what is no longer there, in the world of the map; empty if `appeared`
  MapCloud after;     ///< what is there since, in the world of the map; empty if `gone`
  Pose after_from_before = Pose::Identity();  ///< the motion, in the world of the map, if `moved`
};

/// The box around the points of a cloud. Empty if there are none.
Eigen::AlignedBox3f box_of(const MapCloud& cloud);

/// Number of points before and after.
std::size_t point_count(const MapChange& change);

/// How far the middle of a thing has moved, that is, of the box around what was there before.
double moved_m(const MapChange& change);

}  // namespace tofmap

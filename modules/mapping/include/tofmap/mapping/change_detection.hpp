// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <tofmap/mapping/map_change.hpp>
#include <tofmap/mapping/map_content.hpp>

namespace tofmap {

/// Finds what each recording of a map shows to have changed since the recordings before it.
///
/// A surface that several keyframes showed is gone if keyframes of the recording see through it
/// (sightings_of()), at least two and three times as many as agree with it, and the recording has
/// no surface there with a similar normal. What is connected with it and has none either is gone as
/// well, but for noise. Surfaces are new if the same holds with earlier and later recordings
/// exchanged. What no keyframe has seen before or has seen again is no change. Pieces of fewer than
/// `least_points_of_change` points, or of mostly points that free space does not tell about, are
/// left out. A piece that is gone and a new one are a thing that moved if they have the same shape.
///
/// In the order of recordings; those of one recording by kind, the largest first.
std::vector<MapChange> find_changes(const MapContent& content, int map);

/// The changes in all maps.
std::vector<MapChange> find_changes(const MapContent& content);

/// The changes that one recording shows, in all maps.
std::vector<MapChange> changes_since(const MapContent& content, int recording);

/// Smallest number of map points of a change. Fewer are mostly edges of things, which each
/// recording sees a bit differently.
inline constexpr std::size_t least_points_of_change = 20;

}  // namespace tofmap

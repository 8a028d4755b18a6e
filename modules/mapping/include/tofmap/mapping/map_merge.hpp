// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/mapping/map_content.hpp>
#include <tofmap/mapping/room_mapper.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// Maps of one building, joined in one world frame.
struct MergedMaps {
  MapContent content;  ///< of those maps that could be joined with the first one
  /// For each of the given maps, how near it came to being joined, when that was last tried. Of the
  /// first one, nothing.
  std::vector<MapNearness> nearness;
  std::vector<bool> is_joined;  ///< for each of the given maps; the first one is
};

/// Merges maps of one building, without knowledge of their relative poses and in any order.
///
/// The keyframes of each map are compared with those of the maps that are joined already. Maps are
/// joined where places are recognised with certainty (choose_join() or find_certain_join()).
/// `spacing` is the distance at which the keyframes were taken. Those that do not fit the first one
/// are tried again when others were joined, and if none fits, are joined with each other first: two
/// maps may have too little in common with the first one, and together enough. Loops between the
/// maps then correct the poses of all keyframes. The world frame is that of the first map.
/// Recordings are put in the order of their dates.
///
/// Of a map that consists of several that could not be joined, the one with the most keyframes is
/// joined; the others stay separate.
///
/// `tell` is called with the index of the map that is compared, before each of its keyframes. It
/// may be empty; an exception that it throws is passed on. Throws UsageError if there is no map, if
/// cameras or options of surfaces differ, or if two maps have a recording in common.
MergedMaps merge_maps(std::vector<MapContent> maps, const KeyframeSpacing& spacing,
                      const LoopOptions& loops, const RegistrationOptions& registration,
                      const std::function<void(std::size_t map)>& tell = {});

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/map_content.hpp>

namespace tofmap {

/// Number of keyframes that must see through a point, or agree with it. A single one may be
/// deceived.
inline constexpr int least_views = 2;

/// How certain it is that a surface was at a point.
enum class Certainty {
  none,      ///< all pixels that saw it cover too much of it
  possible,  ///< a keyframe shows it, by pixels that cover up to twice as much
  sure,      ///< several keyframes show it well
};

/// The surface of a map, as some of its recordings saw it.
struct SeenSurface {
  MapCloud points;                   ///< without free-space violations
  std::vector<Certainty> certainty;  ///< of each point
  std::vector<Keyframe> keyframes;
};

/// The surface that the recordings from `first` to before `end` saw in a map.
SeenSurface surface_seen(const MapContent& content, int map, int first, int end);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/simulation/scenes.hpp>

namespace tofmap {

/// The scene after `count` pieces of its furniture were rearranged: in turn, pieces are taken away,
/// put in anew, and moved. What a piece carries goes along with it. Only what can be seen from the
/// scene's path is rearranged. `seed` determines what and where.
///
/// Moved pieces stay on the floor, and their centres move by 0.3 m to 2.5 m. New pieces are boxes,
/// cupboards and tables on the floor. Both keep 0.5 m away from the path, and intersect neither the
/// surface before the rearrangement, apart from a moved piece's own old place, nor each other.
///
/// The other triangles of the surface stay the same to the bit, in the same order. Fewer pieces are
/// rearranged, down to none, if there is no furniture or no free floor in view
/// (rearranged_count()). The scene must not have been rearranged before.
Scene rearranged(Scene scene, int count, int seed);

/// Another walk through the scene: a smooth path that deviates from the scene's path by some
/// decimetres and by some degrees of the viewing direction, and begins elsewhere if it is closed.
/// `seed` determines the walk; 0 returns the scene's path. The walk keeps 0.3 m or more away from
/// the surface where the scene's path does, and nowhere comes nearer to it than that path. Where
/// the scene lacks the space, it follows the scene's path and only looks elsewhere.
CameraPath other_walk(const Scene& scene, int seed);

}  // namespace tofmap

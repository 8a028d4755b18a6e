// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "seen_surface.hpp"

#include <vector>

namespace tofmap {

/// The connected pieces of a surface that keyframes of another time see through. `other` is the
/// surface that these saw.
std::vector<MapCloud> pieces_seen_through(const SeenSurface& surface, const SeenSurface& other,
                                          const MapContent& content);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "seen_surface.hpp"

#include <vector>

namespace tofmap {

/// The connected pieces of a surface that violate the free space of keyframes of another time.
/// `other` is the surface that these saw.
std::vector<MapCloud> pieces_violating_free_space(const SeenSurface& surface,
                                                  const SeenSurface& other,
                                                  const MapContent& content);

}  // namespace tofmap

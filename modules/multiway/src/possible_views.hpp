// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/registration/oriented_cloud.hpp>
#include <tofmap/registration/spherical_view.hpp>

namespace tofmap {

/// Views of a cloud from the places where its sensor may have been, if that is not known. `levels`
/// are the same cloud from coarse to fine, in metres; the views show the finest level.
///
/// A place is possible if hardly any point is hidden from it: at most 5 %, and at most 1 % more
/// than from the best place. Places are searched in and a little around the box of the cloud, on a
/// grid and by descent from the six best places of the grid that are apart. Empty if there is no
/// such place, as for most clouds that were merged from several scans.
///
/// Something may contradict a cloud only if it does so in all of these views.
std::vector<SphericalView> possible_views(std::span<const OrientedCloud> levels);

}  // namespace tofmap

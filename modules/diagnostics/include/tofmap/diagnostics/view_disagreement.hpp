// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/diagnostics/ranged_frame.hpp>

namespace tofmap {

/// By how much frames disagree about where the surfaces are that they see, without what noise
/// explains: a root mean square distance, metres. It grows with systematic errors of ranges that
/// depend on the viewpoint, such as those by stray light, and with errors of poses.
///
/// Each image is divided into patches, about 22 along its width, and a plane is fitted to each of
/// them. The centre of a patch that other frames see has a distance from their planes. The noise of
/// such a distance is independent of that of the next patch but one, and thus absent, on average,
/// from the product of both; what remains is the variance of what both patches share. Distances of
/// more than three robust standard deviations are clipped, so that neither things that move nor
/// wrong wrap counts decide. Distances of surfaces at a range r beyond 8 m are multiplied by 8 m /
/// r: small rotations of a frame move them in proportion to r. The images must be those after
/// filters. NaN if frames overlap too little.
double view_disagreement_m(const std::vector<RangedFrame>& frames, const CameraModel& camera);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// Whether the phases of a recording were computed from depth along the optical axis as if it were
/// range along the rays. Phases of ranges reach up to one cycle in every pixel. Phases computed
/// from depth reach up to cos θ cycles, where θ is the angle between the pixel's ray and the
/// optical axis. The difference shows only towards the border of the image and in scenes that reach
/// beyond one wavelength; returns false if the frames do not show it.
bool looks_like_axial_depth(const std::vector<Frame>& frames, const SensorModel& sensor);

/// A warning, with the remedy, if looks_like_axial_depth(); otherwise empty.
std::optional<std::string> axial_depth_warning(const std::vector<Frame>& frames,
                                               const SensorModel& sensor);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// Whether what is given as phases along the rays of pixels is depth along the optical axis:
/// towards the border of the image it ends at the cosine of the ray's angle, and not at a whole
/// cycle. Only scenes beyond a wavelength tell; false if they do not.
bool looks_like_axial_depth(const std::vector<DualFrequencyFrame>& frames,
                            const SensorModel& sensor);

/// The same as a sentence with the remedy; nothing if it does not look so.
std::optional<std::string> axial_depth_warning(const std::vector<DualFrequencyFrame>& frames,
                                               const SensorModel& sensor);

}  // namespace tofmap

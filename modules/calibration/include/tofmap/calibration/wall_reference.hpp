// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// How far a flat wall was from the optical centre in some frames of a recording, along the wall's
/// normal: by frame index, metres.
using WallDistances = std::map<int, double>;

/// Reads lines 'frame distance' ('#' begins a comment). Throws InputError that names file and line
/// for anything else, and for distances that are not positive.
WallDistances read_wall_distances(const std::filesystem::path& file);

/// The ranges of a flat wall that fills most of the image, at a known distance: how it is tilted is
/// found from the phases of A. Nothing if less than half of the returns lie on one plane there.
///
/// The wall may be tilted as long as half of it is within half a wavelength of where it would be
/// without tilt. An offset of A below a quarter of a wavelength does not matter.
std::optional<ImageF> wall_range(const DualFrequencyFrame& frame, const SensorModel& sensor,
                                 double distance_m);

}  // namespace tofmap

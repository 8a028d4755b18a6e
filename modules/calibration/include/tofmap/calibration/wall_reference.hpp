// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/frame.hpp>

namespace tofmap {

/// Distances of a flat wall from the optical centre along the normal of the wall, in metres, by
/// frame index. Not every frame of a recording needs one.
using WallDistances = std::map<int, double>;

/// Reads a file with lines 'frame distance_m'; '#' begins a comment. Throws InputError, which names
/// file and line, if a line has another form, a distance is not positive, or a frame is given
/// twice. Throws InputError if the file cannot be read or has no such line.
WallDistances read_wall_distances(const std::filesystem::path& file);

/// Throws InputError, which names `file`, if a distance exceeds 100 m, from where no wall fills the
/// image, or if the recording does not have one of the frames.
void check_wall_distances(const WallDistances& distances_m, const std::filesystem::path& file,
                          const SequenceReader& recording);

/// The radial ranges of a flat wall that fills most of the image, in metres. `distance_m` is the
/// distance of the wall from the optical centre along its normal; the tilt of the wall is estimated
/// from the phases of A. NaN where a ray does not meet the wall, or only at a grazing angle.
///
/// `distance_m` must be above 0. Empty if less than half of the returns lie on one plane at this
/// distance. The tilt can be found if at least half of the wall is within half a wavelength of
/// where it would be without tilt, and if the offset of A is below a quarter of a wavelength.
std::optional<ImageF> wall_range(const Frame& frame, const SensorModel& sensor, double distance_m);

}  // namespace tofmap

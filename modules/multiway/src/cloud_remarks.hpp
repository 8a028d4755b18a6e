// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_units.hpp"

#include <span>
#include <string>
#include <vector>

#include <tofmap/multiway/cloud_registration.hpp>

namespace tofmap {

// Remarks about clouds that are unusual or not registered.

/// Why a cloud is not registered, from the best of its pairs. Empty if it has no pair.
std::string why_not_registered(int cloud, const std::vector<CloudPair>& pairs,
                               std::span<const std::string> names);

/// Remark about a cloud that fits no other and is `ratio` times as large as the others.
std::string odd_size(double ratio);

/// Remark about a cloud that fits the cloud `name_of_fitting` if it is scaled by a unit.
std::string other_unit(const LengthUnit& unit, const std::string& name_of_fitting);

/// Error message for voxels smaller than `least_m`.
std::string too_fine(double voxel_m, double least_m);

}  // namespace tofmap

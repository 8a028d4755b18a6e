// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_units.hpp"

#include <span>
#include <string>
#include <vector>

#include <tofmap/multiway/cloud_registration.hpp>

namespace tofmap {

// What is said of clouds that are odd or not registered.

/// By the pair that came nearest; empty if there is no pair.
std::string why_not_registered(int cloud, const std::vector<CloudPair>& pairs,
                               std::span<const std::string> names);

/// A cloud so many times as large as the others that fits none of them.
std::string odd_size(double ratio);

std::string other_unit(const LengthUnit& unit, const std::string& name_of_fitting);

/// That the voxels wanted are too fine, and how fine they may be.
std::string too_fine(double voxel_m, double least_m);

}  // namespace tofmap

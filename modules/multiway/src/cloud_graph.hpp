// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/multiway/cloud_registration.hpp>

namespace tofmap {

/// Fits poses of clouds to all registered pairs. Poses are in the frame of the first cloud of the
/// largest connected part; clouds outside of that part have none. Pairs that contradict others get
/// the verdict `disagrees` and connect nothing. All poses are between centred frames
/// (LevelledCloud::centre_m). `slack_m` is the standard deviation of errors that the covariance of
/// a pair does not include.
std::vector<std::optional<Pose>> fit_graph(std::size_t clouds, std::vector<CloudPair>& pairs,
                                           double slack_m, double kernel_width);

}  // namespace tofmap

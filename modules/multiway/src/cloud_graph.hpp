// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/multiway/cloud_registration.hpp>

namespace tofmap {

/// Poses of clouds that fit the pairs that were registered, in the frame of the first cloud of the
/// largest connected part; nothing for clouds outside of it. Pairs that the others contradict are
/// marked as such, and tie nothing. Poses of pairs and results are those of the clouds' centred
/// frames. `slack_m` is what registration may be off beyond its covariance.
std::vector<std::optional<Pose>> fit_graph(std::size_t clouds, std::vector<CloudPair>& pairs,
                                           double slack_m, double kernel_width);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "peers/range_hypotheses.hpp"

namespace tofmap::peers {

/// The spatial kernel density at every hypothesis (Järemo Lawin et al. 2016, equations 11 to 14),
/// with the margins of `hypotheses`. Weights add to at least `least_total_weight`.
std::array<ImageF, most_hypotheses> kernel_densities(const RangeHypotheses& hypotheses,
                                                     int support_radius_px, double spatial_sigma_px,
                                                     double least_total_weight);

}  // namespace tofmap::peers

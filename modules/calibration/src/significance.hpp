// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tofmap {

/// Errors below this number of standard deviations are left out of a calibration.
inline constexpr double least_significance = 4;

/// Number of samples that count as one independent sample. Pixels of one surface share errors from
/// the lens, stray light and edges.
inline constexpr double correlated_samples = 30;

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace tofmap {

/// What the directions of points are like, seen from a place (ScanPattern).
struct Pattern {
  double hidden_share = 0;
  double roughness = 0;
};

/// Measures the pattern from a single place. Empty if too few directions are kept, or if they are
/// copies of each other.
std::optional<Pattern> pattern_at(std::span<const Eigen::Vector3d> points,
                                  const Eigen::Vector3d& place);

}  // namespace tofmap

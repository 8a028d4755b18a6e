// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace tofmap {

/// How uncertain a relative pose is, whatever the axis: the largest variances along any axis.
/// Spreads of poses that follow each other add up.
struct PoseSpread {
  double rotation_rad2 = 0;
  double translation_m2 = 0;

  double rotation_sigma_rad() const;
  double translation_sigma_m() const;

  bool operator==(const PoseSpread&) const = default;
};

PoseSpread operator+(const PoseSpread& one, const PoseSpread& other);

/// The one that is smaller in translation.
PoseSpread smaller(const PoseSpread& one, const PoseSpread& other);

/// The one that is larger in translation.
PoseSpread larger(const PoseSpread& one, const PoseSpread& other);

/// The spread of a pose error with this covariance: rotation vector, radians, then translation,
/// metres.
PoseSpread spread_of(const Eigen::Matrix<double, 6, 6>& covariance);

}  // namespace tofmap

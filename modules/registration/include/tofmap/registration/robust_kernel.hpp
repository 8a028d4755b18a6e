// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tofmap {

/// Weight of a residual by the kernel of Geman and McClure, from the squares of residual and width,
/// so that no root is needed: 1 without a residual, a quarter at the width.
inline double geman_mcclure_weight_of_squares(double squared_residual, double squared_width) {
  const double ratio = squared_width / (squared_width + squared_residual);
  return ratio * ratio;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/frame_errors.hpp"

#include <cmath>

namespace tofmap {

double CameraErrors::periodic_rms_m() const {
  double squares = 0;
  for (int i = 1; i + 1 < coefficients; ++i) {
    const double amplitude_m = coefficient_m[static_cast<std::size_t>(i)];
    squares += amplitude_m * amplitude_m / 2;
  }
  return std::sqrt(squares);
}

}  // namespace tofmap

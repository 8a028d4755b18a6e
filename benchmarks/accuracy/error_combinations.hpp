// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap::accuracy {

/// Systematic errors and noise of a camera (docs/simulator.md, equations 9 to 13). By default,
/// there is only photon noise.
struct CameraErrors {
  double offset_m = 0;             ///< range offset of B
  double periodic_a_m = 0;         ///< peak periodic error of A
  double periodic_b_m = 0;         ///< peak periodic error of B
  double amplitude_error_a_m = 0;  ///< change of the range of A over three decades of amplitude
  double amplitude_error_b_m = 0;  ///< change of the range of B over three decades of amplitude
  double pattern_m = 0;            ///< standard deviation of the fixed pattern
  double delay_share = 0;          ///< delay of B after A, frame periods: 0, 0.1, 0.5 or 1
  double ambient_noise = 1;        ///< factor of the noise in the rectangle of ambient light
  double ambient_left = 0.5;       ///< edges of this rectangle, fractions of the image
  double ambient_top = 0;
  double ambient_right = 1;
  double ambient_bottom = 0.5;
  double noise_m = 0.02;  ///< SimulatorOptions::range_noise_m

  bool has_ambient() const { return ambient_noise > 1; }

  /// Whether there is only photon noise.
  bool are_none() const;
};

/// The options of `base` with these errors.
SimulatorOptions with_errors(SimulatorOptions base, const CameraErrors& errors);

/// One row of the grid.
struct Combination {
  std::string kind;  ///< kind of error: "offset", "two errors", "drawn", …
  std::string size;  ///< size in words: "5 cm"
  CameraErrors errors;
};

/// Which combinations of errors the grid has.
struct GridPlan {
  bool with_pairs = true;  ///< every two errors at their largest
  int drawn = 40;          ///< number of random combinations
  int seed = 1;            ///< seed of the random combinations
};

/// Each error alone at each of its sizes, every two errors at their largest, and random
/// combinations. Each noise is also used alone, without systematic errors.
std::vector<Combination> error_combinations(const GridPlan& plan);

}  // namespace tofmap::accuracy

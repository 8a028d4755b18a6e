// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap::accuracy {

/// What is wrong with a camera's ranges (docs/simulator.md, equations 9 to 13), and how noisy they
/// are. By default nothing but photon noise.
struct CameraErrors {
  double offset_m = 0;      ///< of B
  double periodic_a_m = 0;  ///< peak
  double periodic_b_m = 0;
  double amplitude_error_a_m = 0;  ///< over three decades
  double amplitude_error_b_m = 0;
  double pattern_m = 0;       ///< standard deviation
  double delay_share = 0;     ///< 0, 0.1, 0.5 or 1
  double ambient_noise = 1;   ///< factor, in the rectangle below
  double ambient_left = 0.5;  ///< shares of the image
  double ambient_top = 0;
  double ambient_right = 1;
  double ambient_bottom = 0.5;
  double noise_m = 0.02;

  bool has_ambient() const { return ambient_noise > 1; }

  /// Nothing but photon noise.
  bool are_none() const;
};

/// Sets those options of `base` that the errors are about.
SimulatorOptions with_errors(SimulatorOptions base, const CameraErrors& errors);

/// One row of the grid.
struct Combination {
  std::string kind;  ///< of error: "offset", "two errors", "drawn", …
  std::string size;  ///< "5 cm"
  CameraErrors errors;
};

/// How many of what.
struct GridPlan {
  bool with_pairs = true;
  int drawn = 40;
  int seed = 1;  ///< draws these
};

/// Each error by itself at each size, every two at their largest, and combinations that are drawn.
/// Each noise comes by itself, too: then nothing is wrong.
std::vector<Combination> error_combinations(const GridPlan& plan);

}  // namespace tofmap::accuracy

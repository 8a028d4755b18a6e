// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cases.hpp"
#include "error_combinations.hpp"

#include <string>
#include <vector>

namespace tofmap::accuracy {

/// A scene seen by one camera. The seed is that of the scene, the noise and the camera errors.
struct GridPlace {
  std::string scene;
  int seed = 1;
  SimulatorOptions options;  ///< image size and frequencies
};

/// The scores of one combination of errors at one place.
struct GridRow {
  std::size_t combination = 0;  ///< index in Grid::combinations
  std::string scene;
  int seed = 0;
  Score pixel;
  Score jump;
  Score joint;
  Score joint_without_errors;  ///< same place, motion and noise, and no delay of B
};

struct Grid {
  std::vector<Combination> combinations;
  std::vector<GridRow> rows;  ///< for each place, all combinations in order
  RunPlan runs;

  const CameraErrors& errors_of(const GridRow& row) const {
    return combinations[row.combination].errors;
  }
};

struct GridSettings {
  bool frozen = false;
  bool half = false;   ///< images of half the width and height
  bool quick = false;  ///< two scenes, half images, one seed each, no pairs of errors
};

/// Measures all combinations of errors at all places. Rays are cast once for each place and motion.
/// The figures do not depend on the number of threads.
Grid measure_grid(const GridSettings& settings);

}  // namespace tofmap::accuracy

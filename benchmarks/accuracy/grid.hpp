// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cases.hpp"
#include "error_combinations.hpp"

#include <string>
#include <vector>

namespace tofmap::accuracy {

/// A scene seen by one camera: the scene, the noise's seed and the camera's are given.
struct GridPlace {
  std::string scene;
  int seed = 1;
  SimulatorOptions options;  ///< image size and frequencies
};

/// What a combination of errors made of one place.
struct GridRow {
  std::size_t combination = 0;  ///< index in Grid::combinations
  std::string scene;
  int seed = 0;
  Score pixel;
  Score jump;
  Score joint;
  Score joint_without_errors;  ///< same place, motion and noise; B taken at the instant of A
};

struct Grid {
  std::vector<Combination> combinations;
  std::vector<GridRow> rows;  ///< place by place, each with all combinations in order
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

/// The places and combinations of the settings, measured: rays are cast once a place and motion.
/// The same settings give the same figures, whatever the number of threads.
Grid measure_grid(const GridSettings& settings);

}  // namespace tofmap::accuracy

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reports/report_sections.hpp"

#include <optional>
#include <string>
#include <vector>

#include <tofmap/evaluation/method_run.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap::app {

/// A map as a page shows it. Its points and poses are in the frame of its own first camera.
struct ShownMap {
  std::string name;  ///< "with unwrapping (joint)"
  const MapCloud* surface = nullptr;
  const Trajectory* trajectory = nullptr;
  std::optional<Pose> truth_from_map;  ///< empty if the true path is unknown
  std::optional<std::vector<float>>
      errors_m;  ///< of its points; empty if the true surface is unknown
};

/// A map with its errors as far as they are known. `map` must outlive the result.
ShownMap shown_map(const std::string& name, const RoomMap& map, const MapScores& scores);

/// "with unwrapping (METHOD)", or "without unwrapping" for method "none".
std::string name_of_map(UnwrapMethod method);

/// Adds pictures of the maps side by side from above, a picture of the camera paths, and a 3D view
/// of the maps. All have the same scale and the gravity-aligned frame of the first map, and are
/// coloured by height and, if errors are known, by error. `maps` must not be empty, `truth` may be.
void add_maps(ReportPage& page, const std::vector<ShownMap>& maps, const Trajectory& truth,
              const ReportOptions& options);

}  // namespace tofmap::app

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

/// A map as a page compares it with others, all in the frame of the first camera.
struct ShownMap {
  std::string name;  ///< "with unwrapping (joint)"
  const MapCloud* surface = nullptr;
  const Trajectory* trajectory = nullptr;
  std::optional<Pose> truth_from_map;          ///< if the true path is known
  std::optional<std::vector<float>> errors_m;  ///< of its points, if the true surface is known
};

/// A map, which must outlive it, with what is known of its errors.
ShownMap shown_map(const std::string& name, const RoomMap& map, const MapScores& scores);

/// "with unwrapping (joint)", or that there was none.
std::string name_of_map(const std::string& method);

/// Maps side by side from above and the paths of the cameras, on one scale and in the level frame
/// of the first; then the maps to be turned. By error, where one is known. `truth` may be empty.
void add_maps(ReportPage& page, const std::vector<ShownMap>& maps, const Trajectory& truth,
              const ReportOptions& options);

}  // namespace tofmap::app

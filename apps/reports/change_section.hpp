// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/mapping/map_content.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap::app {

/// Adds what has changed between the recordings of a map: a picture from above and a table. Adds
/// nothing if there is nothing.
void add_changes(ReportPage& page, const MapCloud& surface, const Trajectory& trajectory,
                 const std::vector<MapChange>& changes,
                 const std::vector<MapRecording>& recordings);

}  // namespace tofmap::app

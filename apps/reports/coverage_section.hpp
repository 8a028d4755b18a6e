// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/pipeline/room_map.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap::app {

/// Adds what the main map does not show: the separate maps, from above and with their frames, and
/// the frames that are in no map, with the reasons. Adds nothing if the main map has all frames.
void add_coverage(ReportPage& page, const RoomMap& map);

}  // namespace tofmap::app

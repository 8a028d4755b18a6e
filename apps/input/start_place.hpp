// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <tofmap/mapping/room_mapper.hpp>

namespace CLI {
class App;
}

namespace tofmap::app {

/// Adds --start to a command that finds a camera in a map.
void add_start_option(CLI::App& command, std::string& start);

/// The place that --start names in a map: the id of a keyframe, a position x,y,z in metres, or a
/// pose x,y,z,qx,qy,qz,qw, both in the world of the map with the most keyframes. Empty if the
/// argument is. Throws UsageError if there is no such place.
std::optional<MapPlace> start_place(const std::string& argument, const MapContent& map);

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include <tofmap/mapping/room_mapper.hpp>
#include <tofmap/pipeline/room_map.hpp>

namespace tofmap::app {

/// How near a map or recording came to being found in a map.
std::string told_nearness(const MapNearness& nearness);

/// Why none of the frames was found in a map, how near they came, and what to do about it.
/// `has_start`: the user said where the camera begins.
std::string told_refusal(const MapNearness& nearness, std::span<const FrameRecord> frames,
                         bool has_start);

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap::app {

/// How near a map or recording came to being found in a map.
std::string told_nearness(const MapNearness& nearness);

/// Why none of `frames` frames was found in a map, how near they came, and what to do about it.
std::string told_refusal(const MapNearness& nearness, std::size_t frames);

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>

namespace tofmap {

/// What a RoomMapper knows besides the map: where the camera is and how it moves, and what is still
/// to be decided. With it, a run goes on to the same bits.
struct MapperState {
  std::string json;
  std::vector<std::shared_ptr<const SurfaceCloud>> held;  ///< clouds of frames not registered yet
};

}  // namespace tofmap

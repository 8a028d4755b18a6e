// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// A frame together with the ranges that were found for it. Frame and image have the same size and
/// must outlive this struct.
struct RangedFrame {
  const Frame* frame = nullptr;           ///< may be null if no phases are used
  const RangeImage* image = nullptr;      ///< not null
  std::optional<Pose> world_from_camera;  ///< empty if the frame was not registered
};

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <tofmap/core/camera.hpp>

namespace tofmap {

/// A warning if the focal lengths differ by more than a quarter: pixels are square, or nearly.
/// Otherwise empty.
std::optional<std::string> camera_warning(const CameraModel& camera);

}  // namespace tofmap

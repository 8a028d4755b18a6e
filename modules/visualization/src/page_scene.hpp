// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <tofmap/visualization/report_page.hpp>

namespace tofmap {

/// A scene as page/scene.js reads it: places as 16-bit shares of the box around all, in base64.
/// Throws UsageError if clouds lack normals or colours, or have points that are nowhere.
std::string scene_json(const PageScene& scene);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <tofmap/visualization/report_page.hpp>

namespace tofmap {

/// A scene as JSON for page/scene.js. Coordinates are 16-bit fractions of the bounding box of the
/// scene, in base64. Throws UsageError if the normals, colours or colourings of a cloud have the
/// wrong number, or its points or normals are not finite.
std::string scene_json(const PageScene& scene);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

/// The fixed parts of every page: files of src/page, and three.js with its OrbitControls from
/// Debian.
namespace tofmap::page_texts {

extern const std::string_view style;
extern const std::string_view strip;
extern const std::string_view scene;
extern const std::string_view three_notice;
extern const std::string_view three;
extern const std::string_view orbit_controls;

}  // namespace tofmap::page_texts

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// A warning, with the remedy, if two frequencies have the same phase images: in most frames,
/// nearly all pixels that have a return at one of them have the same phase at both. Otherwise
/// empty.
std::optional<std::string> copied_images_warning(const std::vector<Frame>& frames);

}  // namespace tofmap

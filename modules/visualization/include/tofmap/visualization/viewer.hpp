// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <tofmap/visualization/drawing.hpp>

namespace tofmap {

/// Shows a drawing in a window until it is closed: the left button turns, the middle one shifts,
/// the wheel zooms, q ends. Throws DrawingError if there is no display.
void show(const Drawing& drawing, const Viewpoint& viewpoint, const std::string& title);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tofmap/visualization/drawing.hpp"

class vtkRenderer;

namespace tofmap {

/// What a renderer draws, without a window. Throws DrawingError if there is no way to draw.
Picture picture_of(vtkRenderer& renderer, int width_px, int height_px);

}  // namespace tofmap

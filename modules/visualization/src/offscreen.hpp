// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tofmap/visualization/drawing.hpp"

class vtkRenderer;

namespace tofmap {

/// A picture of the contents of a renderer, drawn without a display. Throws DrawingError if this
/// machine cannot draw.
Picture picture_of(vtkRenderer& renderer, int width_px, int height_px);

}  // namespace tofmap

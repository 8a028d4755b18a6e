// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tofmap/visualization/drawing.hpp"

#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

namespace tofmap {

/// All layers as actors, the camera at the viewpoint; not in a window yet.
vtkSmartPointer<vtkRenderer> make_renderer(const Drawing& drawing, const Viewpoint& viewpoint);

/// Other actors in place of all that a renderer has.
void replace_drawing(vtkRenderer& renderer, const Drawing& drawing);

void look_from(vtkRenderer& renderer, const Viewpoint& viewpoint);

}  // namespace tofmap

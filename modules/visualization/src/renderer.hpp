// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tofmap/visualization/drawing.hpp"

#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

namespace tofmap {

/// A renderer with an actor for each layer of the drawing, seen from the viewpoint. It does not
/// belong to a window yet.
vtkSmartPointer<vtkRenderer> make_renderer(const Drawing& drawing, const Viewpoint& viewpoint);

/// Replaces all actors of a renderer by those of a drawing.
void replace_drawing(vtkRenderer& renderer, const Drawing& drawing);

/// Moves the camera of a renderer to a viewpoint.
void look_from(vtkRenderer& renderer, const Viewpoint& viewpoint);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tofmap/visualization/drawing.hpp"

#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

namespace tofmap {

/// All layers as actors, the camera at the viewpoint; not in a window yet.
vtkSmartPointer<vtkRenderer> make_renderer(const Drawing& drawing, const Viewpoint& viewpoint);

}  // namespace tofmap

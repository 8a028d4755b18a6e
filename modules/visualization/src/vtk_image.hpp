// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tofmap/visualization/picture.hpp"

#include <vtkSmartPointer.h>

class vtkImageData;

namespace tofmap {

/// A picture as a VTK image, whose rows begin at the bottom.
vtkSmartPointer<vtkImageData> vtk_image(const Picture& picture);

}  // namespace tofmap

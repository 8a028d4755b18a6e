// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/picture.hpp"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

namespace tofmap {

Picture text_picture(const std::string& text, int size_px) {
  vtkNew<vtkTextProperty> style;
  style->SetFontFamilyToArial();
  style->SetFontSize(size_px);
  style->SetColor(0, 0, 0);
  vtkNew<vtkImageData> image;
  int used[2] = {0, 0};
  constexpr int dots_per_inch = 72;  // a point is a pixel
  if (!vtkTextRenderer::GetInstance()->RenderString(style, vtkStdString(text), image, used,
                                                    dots_per_inch)) {
    return {};
  }
  const int* extent = image->GetExtent();  // may be larger than the text, and start below zero
  Picture out(used[0], used[1]);
  for (int y = 0; y < out.height_px; ++y) {
    for (int x = 0; x < out.width_px; ++x) {
      const auto* rgba = static_cast<const unsigned char*>(
          image->GetScalarPointer(extent[0] + x, extent[2] + out.height_px - 1 - y, 0));
      const auto gray = static_cast<std::uint8_t>(255 - rgba[3]);
      out.at(x, y) = {gray, gray, gray};
    }
  }
  return out;
}

}  // namespace tofmap

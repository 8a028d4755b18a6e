// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/picture.hpp"

#include "text.hpp"
#include "vtk_image.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <tofmap/core/error.hpp>

namespace tofmap {

Picture::Picture(int width, int height, Rgb fill)
    : width_px(width),
      height_px(height),
      pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {}

Picture magnified(const Picture& picture, int factor) {
  Picture out(picture.width_px * factor, picture.height_px * factor);
  for (int y = 0; y < out.height_px; ++y) {
    for (int x = 0; x < out.width_px; ++x) out.at(x, y) = picture.at(x / factor, y / factor);
  }
  return out;
}

void paste(Picture& onto, const Picture& part, int x, int y) {
  const int left = std::max(0, -x);
  const int right = std::min(part.width_px, onto.width_px - x);
  for (int row = std::max(0, -y); row < std::min(part.height_px, onto.height_px - y); ++row) {
    for (int col = left; col < right; ++col) onto.at(x + col, y + row) = part.at(col, row);
  }
}

void fill(Picture& onto, int x, int y, int width, int height, Rgb color) {
  for (int row = std::max(0, y); row < std::min(y + height, onto.height_px); ++row) {
    for (int col = std::max(0, x); col < std::min(x + width, onto.width_px); ++col) {
      onto.at(col, row) = color;
    }
  }
}

Picture beside(const std::vector<Picture>& pictures, int gap_px) {
  int width = gap_px * (static_cast<int>(pictures.size()) - 1);
  int height = 0;
  for (const Picture& picture : pictures) {
    width += picture.width_px;
    height = std::max(height, picture.height_px);
  }
  Picture out(std::max(0, width), height);
  int x = 0;
  for (const Picture& picture : pictures) {
    paste(out, picture, x, 0);
    x += picture.width_px + gap_px;
  }
  return out;
}

Picture stacked(const std::vector<Picture>& pictures, int gap_px) {
  int height = gap_px * (static_cast<int>(pictures.size()) - 1);
  int width = 0;
  for (const Picture& picture : pictures) {
    height += picture.height_px;
    width = std::max(width, picture.width_px);
  }
  Picture out(width, std::max(0, height));
  int y = 0;
  for (const Picture& picture : pictures) {
    paste(out, picture, 0, y);
    y += picture.height_px + gap_px;
  }
  return out;
}

Picture titled(const Picture& picture, const std::string& title) {
  constexpr int gap_px = 6;
  return stacked({text_picture(title, text_size_px), picture}, gap_px);
}

Picture with_margin(const Picture& picture, int margin_px) {
  Picture out(picture.width_px + 2 * margin_px, picture.height_px + 2 * margin_px);
  paste(out, picture, margin_px, margin_px);
  return out;
}

Picture color_bar(const ColorScale& scale, int height_px) {
  constexpr int bar_px = 24;
  constexpr int tick_px = 6;
  constexpr int gap_px = 4;
  const Picture label = text_picture(scale.label(), text_size_px);
  const int top = label.height_px + text_size_px;
  const int length = std::max(1, height_px - top - text_size_px);
  Picture out(std::max(label.width_px, bar_px + tick_px + gap_px + 4 * text_size_px), height_px);
  paste(out, label, 0, 0);
  const double range = scale.high() - scale.low();
  for (int y = 0; y < length; ++y) {
    const double value = scale.high() - range * y / std::max(1, length - 1);
    fill(out, 0, top + y, bar_px, 1, scale(value));
  }
  for (const double tick : scale.ticks(6)) {
    const int y = top + static_cast<int>(std::lround((scale.high() - tick) / range * (length - 1)));
    fill(out, bar_px, y, tick_px, 1, colors::black);
    const Picture number = text_picture(short_number(tick), text_size_px);
    paste(out, number, bar_px + tick_px + gap_px, y - number.height_px / 2);
  }
  return out;
}

Picture color_key(const std::vector<LegendEntry>& entries) {
  constexpr int gap_px = 8;
  std::vector<Picture> lines;
  for (const LegendEntry& entry : entries) {
    lines.push_back(beside(
        {Picture(text_size_px, text_size_px, entry.color), text_picture(entry.name, text_size_px)},
        gap_px));
  }
  return stacked(lines, gap_px);
}

vtkSmartPointer<vtkImageData> vtk_image(const Picture& picture) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(picture.width_px, picture.height_px, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < picture.height_px; ++y) {
    // VTK counts rows from the bottom.
    auto* row =
        static_cast<unsigned char*>(image->GetScalarPointer(0, picture.height_px - 1 - y, 0));
    for (int x = 0; x < picture.width_px; ++x) {
      const Rgb& color = picture.at(x, y);
      *row++ = color.red;
      *row++ = color.green;
      *row++ = color.blue;
    }
  }
  return image;
}

std::string encoded_png(const Picture& picture) {
  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn();
  writer->SetInputData(vtk_image(picture));
  writer->Write();
  vtkUnsignedCharArray* png = writer->GetResult();
  return {reinterpret_cast<const char*>(png->GetPointer(0)),
          static_cast<std::size_t>(png->GetNumberOfValues())};
}

void write_picture(const std::filesystem::path& file, const Picture& picture) {
  const std::string png = encoded_png(picture);
  std::ofstream out(file, std::ios::binary);
  out.write(png.data(), static_cast<std::streamsize>(png.size()));
  out.close();
  if (!out) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    throw InputError(file.string() +
                     ": cannot be written; is the disk full, or the folder read-only?");
  }
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/visualization/color.hpp>

namespace tofmap {

/// An RGB image to look at, row by row from the top left.
struct Picture {
  int width_px = 0;
  int height_px = 0;
  std::vector<Rgb> pixels;

  Picture() = default;
  Picture(int width, int height, Rgb fill = colors::white);

  Rgb& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width_px + x]; }
  const Rgb& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width_px + x]; }
};

/// Every pixel as a square of `factor` pixels.
Picture magnified(const Picture& picture, int factor);

/// Copies `part` into `onto` with its top left corner at (x, y); what leaves it is cut off.
void paste(Picture& onto, const Picture& part, int x, int y);

/// Fills a rectangle; what leaves the picture is cut off.
void fill(Picture& onto, int x, int y, int width, int height, Rgb color);

/// Pictures side by side, aligned at their tops, and one above the other, aligned at their left.
Picture beside(const std::vector<Picture>& pictures, int gap_px);
Picture stacked(const std::vector<Picture>& pictures, int gap_px);

/// The picture under a line of text, and with a margin around it.
Picture titled(const Picture& picture, const std::string& title);
Picture with_margin(const Picture& picture, int margin_px);

/// Black text on white, as large as it needs.
Picture text_picture(const std::string& text, int size_px);

/// The legend of a scale, upright, `height_px` high, with ticks and the label.
Picture color_bar(const ColorScale& scale, int height_px);

/// A box of each colour with its name, one below the other.
struct LegendEntry {
  Rgb color;
  std::string name;
};
Picture color_key(const std::vector<LegendEntry>& entries);

/// The bytes of a PNG file.
std::string encoded_png(const Picture& picture);

/// Writes PNG. Throws InputError that names the file if it cannot be written whole.
void write_picture(const std::filesystem::path& file, const Picture& picture);

}  // namespace tofmap

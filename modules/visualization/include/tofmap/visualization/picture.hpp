// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/visualization/color.hpp>

namespace tofmap {

/// An RGB image for display.
struct Picture {
  int width_px = 0;
  int height_px = 0;
  std::vector<Rgb> pixels;  ///< row by row from the top, each row from the left

  Picture() = default;
  Picture(int width, int height, Rgb fill = colors::white);

  Rgb& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width_px + x]; }
  const Rgb& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width_px + x]; }
};

/// A picture in which each pixel is a square of `factor` x `factor` pixels.
Picture magnified(const Picture& picture, int factor);

/// Copies `part` into `onto`, with its top left corner at (x, y). Pixels outside of `onto` are cut
/// off.
void paste(Picture& onto, const Picture& part, int x, int y);

/// Fills a rectangle whose top left corner is at (x, y). Pixels outside of `onto` are cut off.
void fill(Picture& onto, int x, int y, int width, int height, Rgb color);

/// Pictures side by side, aligned at the top.
Picture beside(const std::vector<Picture>& pictures, int gap_px);

/// Pictures one above the other, aligned on the left.
Picture stacked(const std::vector<Picture>& pictures, int gap_px);

/// A picture with a line of text above it.
Picture titled(const Picture& picture, const std::string& title);

/// A picture with a white margin around it.
Picture with_margin(const Picture& picture, int margin_px);

/// Black text on white, in a picture of the size of the text. Empty if it cannot be drawn.
Picture text_picture(const std::string& text, int size_px);

/// A vertical legend of a colour scale, `height_px` high, with ticks and the label.
Picture color_bar(const ColorScale& scale, int height_px);

/// A colour and its meaning in a legend.
struct LegendEntry {
  Rgb color;
  std::string name;
};

/// A legend with one line per entry: a box of the colour, and the name.
Picture color_key(const std::vector<LegendEntry>& entries);

/// The bytes of a PNG file.
std::string encoded_png(const Picture& picture);

/// Writes a PNG file. Throws InputError, with the path, if it cannot be written; no partial file is
/// left.
void write_picture(const std::filesystem::path& file, const Picture& picture);

}  // namespace tofmap

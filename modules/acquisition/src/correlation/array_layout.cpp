// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/correlation/array_layout.hpp"

#include "sizes.hpp"

#include <algorithm>
#include <string>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

std::int64_t expected_size(ArrayAxis axis, const ArraySizes& expected) {
  switch (axis) {
    case ArrayAxis::frame:
      return expected.frames;
    case ArrayAxis::frequency:
      return expected.frequencies;
    case ArrayAxis::step:
      return expected.steps;
    case ArrayAxis::image:
      return expected.images;
    case ArrayAxis::row:
      return expected.rows;
    case ArrayAxis::column:
      return expected.columns;
  }
  return 1;
}

std::string sizes_text(const std::vector<std::int64_t>& sizes) {
  std::string text;
  for (const std::int64_t size : sizes) {
    text += (text.empty() ? "" : " x ") + std::to_string(size);
  }
  return text;
}

/// As in "frame x 4 steps", for messages.
std::string expectation(const std::vector<ArrayAxis>& axes, const ArraySizes& expected) {
  std::string text;
  for (const ArrayAxis axis : axes) {
    const std::int64_t size = expected_size(axis, expected);
    text += (text.empty() ? "" : " x ") + std::string(name_of(axis));
    text += size == 0 ? " (any)" : " (" + std::to_string(size) + ")";
  }
  return text;
}

/// True if rows of images of this width consist of whole runs of the array's fastest axes, and
/// their height of whole ones of the next.
bool fills_pages(const std::vector<std::int64_t>& sizes, std::int64_t height, std::int64_t width) {
  bool width_fits = false;
  bool height_fits = false;
  for (std::size_t first = 0; first <= sizes.size(); ++first) {
    const std::int64_t elements = product(sizes, first);
    width_fits |= elements == width;
    height_fits |= elements == height * width;
  }
  return width_fits && height_fits;
}

/// The number of frames in a file of which only the number of elements counts. The last one may be
/// incomplete in a raw binary file whose slowest axis is `frame`.
std::int64_t frames_in(const ArrayFile& file, const std::vector<ArrayAxis>& axes,
                       std::int64_t elements_a_frame) {
  std::int64_t elements = product(file.sizes());
  const bool may_be_cut =
      file.shape() == ArrayFile::Shape::unknown && axes.front() == ArrayAxis::frame;
  if (may_be_cut) elements += elements_a_frame - 1;
  return elements / elements_a_frame;
}

}  // namespace

const char* name_of(ArrayAxis axis) {
  switch (axis) {
    case ArrayAxis::frame:
      return "frame";
    case ArrayAxis::frequency:
      return "frequency";
    case ArrayAxis::step:
      return "step";
    case ArrayAxis::image:
      return "image";
    case ArrayAxis::row:
      return "row";
    case ArrayAxis::column:
      return "column";
  }
  return "";
}

bool ArrayLayout::has(ArrayAxis axis) const { return std::ranges::count(axes, axis) > 0; }

std::int64_t ArrayLayout::size(ArrayAxis axis) const {
  const auto found = std::ranges::find(axes, axis);
  return found == axes.end() ? 1 : sizes[static_cast<std::size_t>(found - axes.begin())];
}

std::int64_t ArrayLayout::stride_in_frame(ArrayAxis axis) const {
  std::int64_t stride = 1;
  for (std::size_t i = axes.size(); i-- > 0;) {
    if (axes[i] == axis) return stride;
    if (axes[i] != ArrayAxis::frame) stride *= sizes[i];
  }
  return 0;
}

ArrayLayout array_layout(const ArrayFile& file, const std::vector<ArrayAxis>& axes,
                         const ArraySizes& expected, bool reshape) {
  ArrayLayout layout;
  layout.axes = axes;
  std::vector<std::int64_t> given = file.sizes();
  if (file.fortran_order()) {
    std::ranges::reverse(layout.axes);
    std::ranges::reverse(given);
  }
  std::int64_t elements_a_frame = 1;
  for (const ArrayAxis axis : axes) {
    if (axis != ArrayAxis::frame) elements_a_frame *= expected_size(axis, expected);
  }
  const bool any_frames = layout.has(ArrayAxis::frame) && expected.frames == 0;
  const bool exact = file.shape() == ArrayFile::Shape::exact && !reshape;
  layout.frames = layout.has(ArrayAxis::frame) ? expected.frames : 1;
  if (any_frames) layout.frames = frames_in(file, layout.axes, elements_a_frame);
  for (std::size_t i = 0; i < layout.axes.size(); ++i) {
    const bool is_frame = layout.axes[i] == ArrayAxis::frame;
    layout.sizes.push_back(is_frame ? layout.frames : expected_size(layout.axes[i], expected));
  }
  const std::int64_t elements = product(layout.sizes);
  const std::int64_t held = product(given);
  const bool fits = exact                                       ? given == layout.sizes
                    : file.shape() == ArrayFile::Shape::unknown ? held <= elements
                    : file.shape() == ArrayFile::Shape::pages
                        ? held == elements && fills_pages(layout.sizes, given[1], given[2])
                        : held == elements;
  if (fits && layout.frames > 0 && layout.frames <= most_frames) return layout;
  throw InputError(file.path().string() + ": has " +
                   (file.shape() == ArrayFile::Shape::unknown
                        ? std::to_string(held) + " elements"
                        : "the shape " + sizes_text(file.sizes())) +
                   ", but the description expects " + expectation(axes, expected) +
                   (file.shape() == ArrayFile::Shape::pages
                        ? "; a truncated file has fewer pages than its frames need"
                        : ""));
}

bool holds_frame(const ArrayFile& file, const ArrayLayout& layout, std::int64_t frame) {
  if (frame < 0 || frame >= layout.frames) return false;
  const std::int64_t all = product(layout.sizes);
  const auto found = std::ranges::find(layout.axes, ArrayAxis::frame);
  if (found == layout.axes.end()) return file.elements_present() >= all;
  // The last element of the frame lies this far from the end of the array.
  const auto place = static_cast<std::size_t>(found - layout.axes.begin());
  const std::int64_t beyond = (layout.frames - 1 - frame) * product(layout.sizes, place + 1);
  return file.elements_present() >= all - beyond;
}

std::vector<std::byte> read_frame(ArrayFile& file, const ArrayLayout& layout, std::int64_t frame) {
  const auto found = std::ranges::find(layout.axes, ArrayAxis::frame);
  if (found == layout.axes.end()) return file.read(0, product(layout.sizes));
  const auto place = static_cast<std::size_t>(found - layout.axes.begin());
  const std::int64_t run = product(layout.sizes, place + 1);
  const std::int64_t runs = product(layout.sizes) / (run * layout.frames);
  std::vector<std::byte> bytes;
  for (std::int64_t i = 0; i < runs; ++i) {
    const std::vector<std::byte> piece = file.read((i * layout.frames + frame) * run, run);
    bytes.insert(bytes.end(), piece.begin(), piece.end());
  }
  return bytes;
}

}  // namespace tofmap

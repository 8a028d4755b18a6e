// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <tofmap/acquisition/correlation/array_file.hpp>

namespace tofmap {

/// Largest number of frames in a recording: days at any frame rate. Limits what a damaged header
/// can ask for.
inline constexpr int most_frames = 100'000'000;

/// What an index of an array of correlation images counts.
enum class ArrayAxis {
  frame,
  frequency,
  step,
  image,  ///< frequency and step together, in an order that a list gives
  row,
  column
};

/// The name of an axis, as in "frame".
const char* name_of(ArrayAxis axis);

/// The sizes that an array is expected to have.
struct ArraySizes {
  std::int64_t frames = 0;  ///< 0: as many as the file holds
  std::int64_t frequencies = 1;
  std::int64_t steps = 1;  ///< of each frequency
  std::int64_t images = 1;
  std::int64_t rows = 1;
  std::int64_t columns = 1;
};

/// Where the images of a frame are in an array file.
struct ArrayLayout {
  std::vector<ArrayAxis> axes;      ///< the axis that varies slowest in the file is the first one
  std::vector<std::int64_t> sizes;  ///< of the axes
  std::int64_t frames = 1;          ///< number of frames; the last ones may be missing in the file

  bool has(ArrayAxis axis) const;

  /// Size of an axis, 1 if the array does not have it.
  std::int64_t size(ArrayAxis axis) const;

  /// Distance of neighbours along an axis among the elements of one frame, that is, in an array
  /// without the axis `frame`. 0 if the array does not have the axis.
  std::int64_t stride_in_frame(ArrayAxis axis) const;
};

/// The layout of an array file whose indices are `axes`, in numpy's order: the last one varies
/// fastest unless the file is in Fortran order. If `reshape`, the file need only have the right
/// number of elements, not the right shape; raw binary files and images need no more anyway,
/// except that the rows of an image must be made of whole rows of the array. Throws InputError,
/// which names the file, its sizes and the expected ones, if they contradict each other.
ArrayLayout array_layout(const ArrayFile& file, const std::vector<ArrayAxis>& axes,
                         const ArraySizes& expected, bool reshape = false);

/// True if the file is long enough to hold this frame.
bool holds_frame(const ArrayFile& file, const ArrayLayout& layout, std::int64_t frame);

/// The elements of one frame, in the order of the axes other than `frame`. Only they are read. If
/// `frame` is the slowest axis, they are read at once, else in as many pieces as the slower axes
/// have elements. Throws InputError, which names the file, if it is too short or damaged.
std::vector<std::byte> read_frame(ArrayFile& file, const ArrayLayout& layout, std::int64_t frame);

}  // namespace tofmap

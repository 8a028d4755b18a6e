// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/core/named_value.hpp>
#include <tofmap/core/option_table.hpp>

namespace tofmap {

/// How the images of all frequencies arrive from a device.
enum class ImageLayout {
  by_tag,       ///< `auto`: as the tag of the images says; images without a tag are refused
  stacked,      ///< each image holds those of all frequencies, one below the other
  alternating,  ///< the images of the frequencies arrive in turn
};

/// What depth images hold.
enum class DepthKind {
  z,       ///< depth along the optical axis, OpenNI2's convention
  radial,  ///< range along the ray of each pixel
};

/// The frequency of the first image of a device that delivers one frequency after another.
enum class FirstImage {
  by_ranges,  ///< `auto`: found from the ranges, since none exceeds the wavelength of its image
  a,
  b,
  c,
  d,
  e,
  f,
  g,
  h,
};

std::span<const NamedValue<ImageLayout>> named_values(ImageLayout);
std::span<const NamedValue<DepthKind>> named_values(DepthKind);
std::span<const NamedValue<FirstImage>> named_values(FirstImage);

/// How a device delivers frames (docs/cameras.md). The images of tofmap's own
/// devices carry a tag that describes them; except for `timeout_s`, the options are for images
/// without a tag.
struct DeviceOptions {
  /// How the images of all frequencies arrive.
  ImageLayout layout = ImageLayout::by_tag;
  /// Modulation frequency of image A in Hz, 0 … 1e9. 0: the device is asked for it.
  double frequency_a_hz = 0;
  /// Modulation frequency of image B in Hz, 0 … 1e9. 0: the device is asked for it.
  double frequency_b_hz = 0;
  /// One to eight modulation frequencies in Hz, 1 … 1e9, in the order of the images, in place of
  /// those of A and B. Empty: those of A and B.
  std::vector<double> frequencies_hz;
  /// What depth images without a tag hold.
  DepthKind depth = DepthKind::z;
  /// Largest range in the scene in metres, 0 … 65.5. 0: unknown.
  double max_range_m = 0;
  /// The frequency of the first image of an alternating device.
  FirstImage first = FirstImage::by_ranges;
  /// Time between two images of an alternating device in seconds, 0 … 10. 0: the inverse of the
  /// device's frame rate.
  double period_s = 0;
  /// Longest time to wait for an image in seconds, 0.1 … 3600. The source ends after it.
  double timeout_s = 5;

  static std::vector<OptionField<DeviceOptions>> fields();
};

}  // namespace tofmap

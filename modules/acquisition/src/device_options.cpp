// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/device_options.hpp"

#include <array>

#include <tofmap/core/modulation.hpp>

namespace tofmap {

std::span<const NamedValue<ImageLayout>> named_values(ImageLayout) {
  static constexpr std::array<NamedValue<ImageLayout>, 3> layouts{
      {{"auto", ImageLayout::by_tag},
       {"stacked", ImageLayout::stacked},
       {"alternating", ImageLayout::alternating}}};
  return layouts;
}

std::span<const NamedValue<DepthKind>> named_values(DepthKind) {
  static constexpr std::array<NamedValue<DepthKind>, 2> kinds{
      {{"z", DepthKind::z}, {"radial", DepthKind::radial}}};
  return kinds;
}

std::span<const NamedValue<FirstImage>> named_values(FirstImage) {
  static constexpr std::array<NamedValue<FirstImage>, 1 + most_frequencies> images{
      {{"auto", FirstImage::by_ranges},
       {"a", FirstImage::a},
       {"b", FirstImage::b},
       {"c", FirstImage::c},
       {"d", FirstImage::d},
       {"e", FirstImage::e},
       {"f", FirstImage::f},
       {"g", FirstImage::g},
       {"h", FirstImage::h}}};
  return images;
}

std::vector<OptionField<DeviceOptions>> DeviceOptions::fields() {
  using D = DeviceOptions;
  return {
      {"layout", &D::layout, 0, 0, "",
       "auto: the tag of the images decides; stacked: each image holds those of all frequencies, A "
       "on top; alternating: the images of the frequencies arrive in turn"},
      {"frequency_a_hz", &D::frequency_a_hz, 0, 1e9, "Hz",
       "modulation frequency of image A, for images without a tag; 0: ask the device"},
      {"frequency_b_hz", &D::frequency_b_hz, 0, 1e9, "Hz",
       "modulation frequency of image B, for images without a tag; 0: ask the device"},
      {"frequencies_hz", &D::frequencies_hz, 1, 1e9, "Hz",
       "one to eight modulation frequencies, in the order of the images, in place of those of A "
       "and "
       "B, for images without a tag; none: A and B"},
      {"depth", &D::depth, 0, 0, "",
       "what depth images without a tag hold; z: depth along the optical axis, OpenNI2's "
       "convention; radial: range along each pixel's ray"},
      {"max_range_m", &D::max_range_m, 0, 65.5, "m",
       "largest range in the scene, for images without a tag; 0: unknown"},
      {"first", &D::first, 0, 0, "",
       "frequency of the first image of an alternating device; auto: determined from the ranges, "
       "since none exceeds the wavelength of its image"},
      {"period_s", &D::period_s, 0, 10, "s",
       "time between two images of an alternating device; 0: from its frame rate"},
      {"timeout_s", &D::timeout_s, 0.1, 3600, "s", "longest time to wait for an image"},
  };
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>

namespace tofmap {

/// How a device writes ranges as whole numbers of 16 bits.
struct RangeScale {
  double unit_m = 1e-4;     ///< of one step
  bool is_z_depth = false;  ///< along the optical axis instead of the pixel's ray
};

/// What an image of a device says of itself, in its last rows.
struct FrameTag {
  std::uint32_t number = 0;  ///< of the frame, as the device counts
  double timestamp_s = 0;    ///< of A, by the device's clock
  SensorModel sensor;
  RangeScale scale;
};

/// One dual-frequency frame as a depth and an infrared image (docs/cameras.md): A above B, and
/// below them the tag, in both.
struct StackedImages {
  ImageU16 range;
  ImageU16 amplitude;
};

/// Rows of the tag in images of that width.
int tag_rows(int width_px);

/// The tag at the end of an image; nothing if there is none, or if it is damaged.
std::optional<FrameTag> read_tag(const ImageU16& image);

/// Phases and amplitudes as the whole numbers of a device's images, and back. No return is 0. A
/// phase that rounds to a range of 0 is written as a whole wavelength, which is the same.
class DeviceImageCodec {
 public:
  /// Throws UsageError if 65534 steps of the scale's unit do not hold both wavelengths.
  DeviceImageCodec(const SensorModel& sensor, const RangeScale& scale);

  /// Both halves and the tag.
  StackedImages stack(const DualFrequencyFrame& frame, std::uint32_t number) const;

  /// What the halves of images hold, tagged or not; the caller sets index and timestamp. The
  /// amplitude may be empty. Throws UsageError if they are not of the camera's size.
  DualFrequencyFrame unstack(const ImageU16& range, const ImageU16& amplitude) const;

  /// Images of one frequency, which are of the camera's size. Where a range is longer than the
  /// wavelength, which cannot be, the phase is NaN.
  ImageU16 encode_range(const ImageF& phase, double wavelength_m) const;
  ImageF decode_range(const Eigen::Ref<const ImageU16>& range, double wavelength_m) const;

  /// How many pixels have a range longer than a wavelength, rounding aside.
  int count_beyond(const Eigen::Ref<const ImageU16>& range, double wavelength_m) const;

 private:
  int rows_of_both(const ImageU16& image) const;

  SensorModel sensor_;
  RangeScale scale_;
  ImageF steps_per_m_;  ///< of radial range
};

/// Amplitudes in the device's unit, at least 1 where there is a return, 65535 at most.
ImageU16 encode_amplitude(const ImageF& amplitude);
ImageF decode_amplitude(const Eigen::Ref<const ImageU16>& amplitude);

}  // namespace tofmap

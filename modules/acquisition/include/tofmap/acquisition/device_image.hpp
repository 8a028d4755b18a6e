// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>

namespace tofmap {

/// How a device represents ranges as integers of 16 bits.
struct RangeScale {
  double unit_m = 1e-4;     ///< range per step of the integer
  bool is_z_depth = false;  ///< true: depth along the optical axis; false: radial range
};

/// The description of a frame that a device writes into the last rows of its images.
struct FrameTag {
  std::uint32_t number = 0;  ///< number of the frame, counted by the device
  double timestamp_s = 0;    ///< time of the first image, by the device's clock
  SensorModel sensor;
  RangeScale scale;
};

/// One frame as a depth image and an infrared image (docs/cameras.md). Each holds the images of all
/// frequencies and the tag, one below the other.
struct StackedImages {
  ImageU16 range;      ///< wrapped ranges; 0: no return
  ImageU16 amplitude;  ///< 0: no return
};

/// Number of rows of the tag in images of this width, for frames of this number of frequencies.
int tag_rows(int width_px, std::size_t frequencies);

/// The tag at the bottom of an image. Empty if the image has no tag or a damaged one.
std::optional<FrameTag> read_tag(const ImageU16& image);

/// Converts phases and amplitudes to the integers of a device's images, and back. The integer 0
/// means no return. A phase whose range rounds to 0 is therefore written as a whole wavelength,
/// which is the same phase.
class DeviceImageCodec {
 public:
  /// Throws UsageError if a wavelength exceeds 65534 steps of the scale.
  DeviceImageCodec(const SensorModel& sensor, const RangeScale& scale);

  /// Encodes a frame with its tag. `number` becomes FrameTag::number. If the frame has no
  /// amplitudes, they are 0.
  StackedImages stack(const Frame& frame, std::uint32_t number) const;

  /// Decodes images with or without a tag. The caller sets index and timestamp of the frame.
  /// `amplitude` may be empty. Throws UsageError if an image does not hold an image of the camera's
  /// size for each frequency.
  Frame unstack(const ImageU16& range, const ImageU16& amplitude) const;

  /// Encodes the phases of one frequency, an image of the camera's size. NaN becomes 0.
  ImageU16 encode_range(const ImageF& phase, double wavelength_m) const;

  /// Decodes the ranges of one frequency to phases. The phase is NaN where there is no return, and
  /// where a range exceeds the wavelength, which no wrapped range does. Throws UsageError if the
  /// image is not of the camera's size.
  ImageF decode_range(const Eigen::Ref<const ImageU16>& range, double wavelength_m) const;

  /// Number of pixels whose range exceeds the wavelength by more than rounding. `range` has the
  /// camera's size.
  int count_beyond(const Eigen::Ref<const ImageU16>& range, double wavelength_m) const;

 private:
  void check_stack(const ImageU16& image) const;

  SensorModel sensor_;
  RangeScale scale_;
  ImageF steps_per_m_;  ///< steps of the scale per metre of radial range
};

/// Rounds amplitudes to integers of 16 bits: 1 … 65535 where the amplitude is above 0, else 0.
ImageU16 encode_amplitude(const ImageF& amplitude);

/// The same numbers as floats.
ImageF decode_amplitude(const Eigen::Ref<const ImageU16>& amplitude);

}  // namespace tofmap

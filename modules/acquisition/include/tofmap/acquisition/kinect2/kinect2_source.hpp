// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <tofmap/acquisition/frame_source.hpp>
#include <tofmap/acquisition/kinect2/recording.hpp>

namespace tofmap {

/// Amplitudes of frames are the amplitudes of packets, `a` in kinect2/phases.hpp, times this
/// factor. The largest amplitude of a pixel that is not saturated, 4/3 · 16320, is then 65 280: it
/// fits into the 16 bits of a sequence, and small amplitudes are not rounded to a few steps.
inline constexpr float kinect2_amplitude_scale = 3;

/// The frames of a Kinect v2's recording, at 80, 16 and 120 MHz.
///
/// What a packet measures becomes a frame in five steps:
/// 1. Phases and amplitudes follow from the three steps of each frequency and the P0 tables
///    (kinect2/phases.hpp).
/// 2. The factors that make amplitudes of the frequencies alike are removed again, because the
///    noise of a phase depends on the amplitude that was measured.
/// 3. Images and camera are mirrored (kinect2/mirror.hpp). The camera frame is then optical, x to
///    the right of somebody who looks along the camera, y down, z forward, and maps are no mirror
///    images of the building. libfreenect2 leaves out this step.
/// 4. Phases are corrected for the light source beside the lens (kinect2/light_source.hpp), so that
///    they are those of radial ranges.
/// 5. A saturated pixel has the sensor's `saturation_amplitude` and the phase 0, which is not used,
///    at the frequency that was saturated. A pixel without signal has no phase (NaN) and the
///    amplitude 0; so have the columns 0 and 511, which packets leave empty.
///
/// A packet that cannot be read or decoded damages its frame only. When within a frame the
/// frequencies are exposed is not known, so that the sensor has no exposure offsets.
class Kinect2Source final : public FrameSource {
 public:
  /// `recording` is what kinect2::open_recording() returned.
  explicit Kinect2Source(kinect2::Recording recording);

  const kinect2::Recording& recording() const { return recording_; }
  const SensorModel& sensor() const override { return sensor_; }
  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override {
    return static_cast<int>(recording_.packets.size());
  }

 private:
  Frame read(const kinect2::RecordedPacket& packet) const;

  kinect2::Recording recording_;
  SensorModel sensor_;
  ImageF half_path_offset_m_;  ///< of the light, in the mirrored images
  std::size_t next_ = 0;
};

}  // namespace tofmap

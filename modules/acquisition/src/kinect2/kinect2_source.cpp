// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/kinect2/kinect2_source.hpp"

#include <tofmap/acquisition/kinect2/light_source.hpp>
#include <tofmap/acquisition/kinect2/mirror.hpp>
#include <tofmap/acquisition/kinect2/packet.hpp>
#include <tofmap/acquisition/kinect2/phases.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

SensorModel sensor_of(const CameraModel& packet_camera) {
  SensorModel sensor;
  sensor.camera = kinect2::mirrored(packet_camera);
  sensor.modulation.frequencies_hz.assign(kinect2::frequencies_hz.begin(),
                                          kinect2::frequencies_hz.end());
  sensor.saturation_amplitude = kinect2::saturated_amplitude;
  return sensor;
}

}  // namespace

Kinect2Source::Kinect2Source(kinect2::Recording recording)
    : recording_(std::move(recording)),
      sensor_(sensor_of(recording_.camera)),
      half_path_offset_m_(kinect2::half_path_offset(
          pixel_rays(sensor_.camera), Eigen::Vector3d(-kinect2::light_source_x_m, 0, 0))) {}

Frame Kinect2Source::read(const kinect2::RecordedPacket& packet) const {
  const kinect2::Phases measured =
      kinect2::phases_from_measurements(kinect2::read_packet(packet.file), recording_.p0);
  Frame frame;
  frame.index = packet.index;
  frame.timestamp_s = packet.timestamp_s;
  for (std::size_t f = 0; f < measured.phase.size(); ++f) {
    const auto is_saturated = (kinect2::mirrored(measured.saturated[f]) != 0).eval();
    const ImageF phase =
        kinect2::shifted_phase(kinect2::mirrored(measured.phase[f]), half_path_offset_m_,
                               sensor_.modulation.wavelength_m(f));
    const float scale = kinect2_amplitude_scale / static_cast<float>(kinect2::amplitude_factors[f]);
    frame.phases.push_back(is_saturated.select(0.0F, phase));
    frame.amplitudes.push_back(is_saturated.select(
        kinect2::saturated_amplitude, scale * kinect2::mirrored(measured.amplitude[f])));
  }
  return frame;
}

std::optional<SourcedFrame> Kinect2Source::next() {
  if (next_ >= recording_.packets.size()) return std::nullopt;
  const kinect2::RecordedPacket& packet = recording_.packets[next_++];
  SourcedFrame sourced{.index = packet.index,
                       .timestamp_s = packet.timestamp_s,
                       .frame = {},
                       .damage = packet.damage};
  if (!packet.damage.empty()) return sourced;
  try {
    sourced.frame = read(packet);
  } catch (const InputError& error) {
    sourced.damage = error.what();
  }
  return sourced;
}

}  // namespace tofmap

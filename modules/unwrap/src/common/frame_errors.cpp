// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/common/frame_errors.hpp"

#include <limits>

#include <tofmap/core/bytes.hpp>

namespace tofmap {

void save(const CameraErrors& camera, ByteWriter& out) {
  out.numbers(camera.coefficient_m);
  out.number(camera.reference_amplitude);
  out.number(camera.amplitude_gain);
  out.number(camera.periodic_rms_m);
  out.number(camera.systematic_m);
  out.number(camera.frames);
  out.number(camera.late_frames);
}

CameraErrors camera_errors_in(ByteReader& in) {
  constexpr int most_frames = std::numeric_limits<int>::max();
  CameraErrors camera;
  in.numbers(camera.coefficient_m);
  camera.reference_amplitude = in.number<double>();
  camera.amplitude_gain = in.number<double>();
  camera.periodic_rms_m = in.number<double>();
  camera.systematic_m = in.number<double>();
  camera.frames = in.number(0, most_frames);
  camera.late_frames = in.number(0, most_frames);
  return camera;
}

}  // namespace tofmap

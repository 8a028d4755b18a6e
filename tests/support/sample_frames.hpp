// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap::test {

/// A small camera with odd numbers in every field, so that a mix-up shows.
inline SensorModel sample_sensor() {
  SensorModel sensor;
  sensor.camera = {7, 5, 6.1234567890123, 6.25, 3.1, 1.9, {0.01, -0.002, 0.0003, -0.0004, 0.005}};
  sensor.modulation = {29e6, 31e6};
  sensor.max_range_m = 12.75;
  return sensor;
}

/// Phases on the 16-bit grid, so that they are kept to the bit; a missing return at A in
/// pixel (0, 0), at B in pixel (1, 1).
inline Frame sample_frame(int index) {
  Frame frame = blank_frame(2);
  frame.index = index;
  frame.timestamp_s = 1305031229.528784 + index / 15.0;
  frame.phases[0].resize(5, 7);
  frame.phases[1].resize(5, 7);
  frame.amplitudes[0].resize(5, 7);
  frame.amplitudes[1].resize(5, 7);
  for (int i = 0; i < 35; ++i) {
    frame.phases[0].data()[i] = static_cast<float>(1870 * i + index) / 65535.0F;
    frame.phases[1].data()[i] = static_cast<float>(65534 - 1000 * i) / 65535.0F;
    frame.amplitudes[0].data()[i] = static_cast<float>(1 + 1900 * i);
    frame.amplitudes[1].data()[i] = static_cast<float>(65535 - 1900 * i);
  }
  frame.phases[0](0, 0) = nan;
  frame.amplitudes[0](0, 0) = 0;
  frame.phases[1](1, 1) = nan;
  frame.amplitudes[1](1, 1) = 0;
  return frame;
}

inline ImageF sample_range_truth() {
  ImageF range_m(5, 7);
  for (int i = 0; i < 35; ++i) range_m.data()[i] = static_cast<float>(1000 + 1800 * i) / 1000.0F;
  range_m(2, 3) = nan;
  return range_m;
}

inline Pose sample_pose(int index) {
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::AngleAxisd(0.1 + 0.2 * index, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  pose.translation() = Eigen::Vector3d(0.25 * index, -1.5, 1.25);
  return pose;
}

}  // namespace tofmap::test

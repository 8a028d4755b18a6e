// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Unwraps a frame of a flat wall at 7 m, where both phases are wrapped once, and checks the ranges.

#include <cmath>
#include <cstdio>

#include <tofmap/unwrap/unwrap.hpp>

namespace {

constexpr double wall_m = 7;

tofmap::SensorModel small_camera() {
  tofmap::SensorModel sensor;
  sensor.camera = {
      .width_px = 32, .height_px = 24, .fx_px = 40, .fy_px = 40, .cx_px = 15.5, .cy_px = 11.5};
  sensor.modulation = {29e6, 31e6};
  sensor.max_range_m = 15;
  return sensor;
}

/// The radial ranges of a camera that faces a wall at depth wall_m.
tofmap::ImageF wall_ranges(const tofmap::CameraModel& camera) {
  return static_cast<float>(wall_m) / tofmap::pixel_rays(camera).z;
}

tofmap::ImageF phases(const tofmap::ImageF& range_m, double wavelength_m) {
  const tofmap::ImageF cycles = range_m / static_cast<float>(wavelength_m);
  return cycles - cycles.floor();
}

}  // namespace

int main() {
  const tofmap::SensorModel sensor = small_camera();
  const tofmap::ImageF truth_m = wall_ranges(sensor.camera);
  tofmap::Frame frame;
  for (const double wavelength_m : tofmap::wavelengths_m(sensor.modulation)) {
    frame.phases.push_back(phases(truth_m, wavelength_m));
  }

  const tofmap::UnwrapResult result = tofmap::unwrap(frame, sensor, {});
  const float worst_m = (result.image.range_m - truth_m).abs().maxCoeff();
  const float middle_m = result.image.range_m(12, 16);
  std::printf("range in the middle: %.4f m, largest error: %.2g m\n", middle_m, worst_m);
  // Phases stored as floats are precise to a few micrometres at 7 to 9 m; one wrap is 5 m.
  return result.image.count_valid() == truth_m.size() && worst_m < 1e-4F ? 0 : 1;
}

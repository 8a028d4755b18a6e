// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/kinect2_recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <tofmap/acquisition/kinect2/light_source.hpp>
#include <tofmap/acquisition/kinect2/mirror.hpp>
#include <tofmap/acquisition/kinect2/phases.hpp>
#include <tofmap/acquisition/kinect2/recording_writer.hpp>
#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/simulation/kinect2_p0.hpp>

namespace tofmap {
namespace {

constexpr float end_of_scale = 65535;  // of simulated amplitudes

/// Where the light source is in images that are not mirrored.
const Eigen::Vector3d light_source_m(-kinect2::light_source_x_m, 0, 0);

/// Half of the light's path minus the range, for each pixel at its true range.
ImageF path_excess(const ImageF& range_m, const CameraModel& camera) {
  const PixelRays rays = pixel_rays(camera);
  ImageF excess_m = kinect2::half_path_offset(rays, light_source_m);
  for (Eigen::Index i = 0; i < excess_m.size(); ++i) {
    const double range = range_m.data()[i];
    if (std::isnan(range)) continue;
    const Eigen::Vector3d ray(rays.x.data()[i], rays.y.data()[i], rays.z.data()[i]);
    excess_m.data()[i] = static_cast<float>(
        kinect2::half_path_from_range(range, ray.normalized(), light_source_m) - range);
  }
  return excess_m;
}

/// Times as the clock of a recorded camera has them: in steps, and without the whole periods before
/// the first one.
class CameraClock {
 public:
  double time_s(double simulated_s) {
    constexpr double ticks_per_s = 8000;
    constexpr double period = 4294967296;  // 32 bits
    const double ticks = std::round(simulated_s * ticks_per_s);
    if (!start_) start_ = period * std::floor(ticks / period);
    return (ticks - *start_) / ticks_per_s;
  }

 private:
  std::optional<double> start_;  ///< in ticks
};

/// Numbers as messages have them: "8e+07, 1e+08".
std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.9g", text.empty() ? "" : ", ", value);
    text += number;
  }
  return text;
}

/// Writes the truth beside a recording.
class TruthWriter {
 public:
  explicit TruthWriter(const std::filesystem::path& folder)
      : ranges_(folder / "range_truth"), poses_file_(folder / "groundtruth.txt") {
    std::error_code error;
    std::filesystem::create_directory(ranges_, error);
    if (error) throw InputError(ranges_.string() + ": cannot be created: " + error.message());
    poses_.open(poses_file_);
    poses_ << "# timestamp tx ty tz qx qy qz qw\n";
  }

  void add(const SimulatedFrame& simulated) {
    char name[24];
    std::snprintf(name, sizeof name, "%06d.png", count_++);
    write_png(ranges_ / name, range_truth_pixels(simulated.range_truth_m));
    write_pose(poses_, {clock_.time_s(simulated.frame.timestamp_s), simulated.world_from_camera});
    if (poses_.flush()) return;
    throw InputError(poses_file_.string() +
                     ": cannot be written; is the disk full, or is permission missing?");
  }

 private:
  std::filesystem::path ranges_;
  std::filesystem::path poses_file_;
  std::ofstream poses_;
  CameraClock clock_;
  int count_ = 0;
};

}  // namespace

SimulatorOptions kinect2_simulator_options() {
  SimulatorOptions options;
  options.width_px = kinect2::image_width_px;
  options.height_px = kinect2::image_height_px;
  options.horizontal_fov_deg = 70.02;  // 2 atan(512 / 2 · 365.456)
  options.frequencies_hz.assign(kinect2::frequencies_hz.begin(), kinect2::frequencies_hz.end());
  options.contrasts = {0.756097, 1, 0.620001};  // 1 / kinect2::amplitude_factors
  options.range_noise_m = 0.008;
  options.frame_rate_hz = 30;
  options.max_translation_m = 0.035;
  options.max_rotation_deg = 1.5;
  return options;
}

void check_fits_packets(const SensorModel& sensor) {
  const CameraModel& camera = sensor.camera;
  if (camera.width_px != kinect2::image_width_px || camera.height_px != kinect2::image_height_px) {
    throw UsageError(
        "a packet of a Kinect v2 holds images of 512 x 424 pixels, but "
        "simulator.width_px and simulator.height_px are " +
        std::to_string(camera.width_px) + " and " + std::to_string(camera.height_px));
  }
  const std::vector<double>& hz = sensor.modulation.frequencies_hz;
  if (!std::ranges::equal(hz, kinect2::frequencies_hz)) {
    throw UsageError(
        "a packet of a Kinect v2 holds the frequencies 80e6, 16e6 and 120e6 Hz, but "
        "simulator.frequencies_hz is " +
        numbers(hz));
  }
}

kinect2::Measurements kinect2_measurements(const SimulatedFrame& simulated,
                                           const SensorModel& sensor, const kinect2::P0Tables& p0) {
  check_fits_packets(sensor);
  const ImageF shorter_m = -path_excess(simulated.range_truth_m, sensor.camera);
  std::array<ImageF, 3> phase;
  std::array<ImageF, 3> amplitude;
  for (std::size_t f = 0; f < phase.size(); ++f) {
    phase[f] = kinect2::mirrored(kinect2::shifted_phase(simulated.frame.phases[f], shorter_m,
                                                        sensor.modulation.wavelength_m(f)));
    // The factor of the frequency is part of the amplitudes that measurements are made from.
    const auto scale =
        static_cast<float>(packet_units_per_amplitude * kinect2::amplitude_factors[f]);
    const ImageF& strength = simulated.frame.amplitudes[f];
    amplitude[f] = kinect2::mirrored(
        ImageF((strength >= end_of_scale).select(kinect2::saturated_amplitude, scale * strength)));
  }
  return kinect2::measurements_from_phases(phase, amplitude, p0);
}

int simulate_kinect2(const Simulator& simulator, int errors_seed,
                     const std::filesystem::path& folder,
                     const std::function<bool(int done, int total)>& keep_going) {
  check_fits_packets(simulator.sensor());
  const kinect2::P0Tables p0 = synthetic_p0_tables(errors_seed);
  kinect2::RecordingWriter writer(folder, kinect2::mirrored(simulator.sensor().camera), p0,
                                  "simulated-" + std::to_string(errors_seed));
  TruthWriter truth(folder);
  write_mesh_ply(folder / "scene.ply", simulator.surface());
  write_furniture(folder / "furniture.json", simulator.furniture());
  const int total = *simulator.frame_count();
  for (int i = 0; i < total; ++i) {
    if (keep_going && !keep_going(i, total)) break;
    const SimulatedFrame simulated = simulator.simulate(i);
    if (simulator.is_stopped()) break;
    writer.add(kinect2_measurements(simulated, simulator.sensor(), p0),
               simulated.frame.timestamp_s);
    truth.add(simulated);
  }
  if (writer.count() == total) writer.finish();
  return writer.count();
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/camera_calibration.hpp"

#include "yaml_section.hpp"

#include <cmath>
#include <fstream>
#include <numbers>

namespace tofmap {
namespace {

constexpr const char* format_name = "tofmap-camera";
constexpr int format_version = 1;

double wrapped(double cycles) { return cycles - std::floor(cycles); }

bool is_nothing(const PhaseError& error) {
  return error.offset_m == 0 && error.harmonics.empty() && error.table_m.empty();
}

/// The error at every phase that 16 bits can hold would be as exact; so many are finer than any
/// camera.
constexpr int steps_a_cycle = 4096;

void correct(ImageF& phase, const PhaseError& error, double wavelength_m) {
  if (is_nothing(error)) return;
  std::vector<float> error_cycles(steps_a_cycle + 1);
  for (int i = 0; i <= steps_a_cycle; ++i) {
    const double cycles = static_cast<double>(i) / steps_a_cycle;
    error_cycles[static_cast<std::size_t>(i)] =
        static_cast<float>(error.at_m(cycles) / wavelength_m);
  }
  for (float& value : phase.reshaped<Eigen::AutoOrder>()) {
    if (std::isnan(value)) continue;
    const float place = value * steps_a_cycle;
    const auto before = static_cast<std::size_t>(place);
    const float share = place - static_cast<float>(before);
    const float off = (1 - share) * error_cycles[before] + share * error_cycles[before + 1];
    const auto corrected = static_cast<float>(wrapped(double{value} - double{off}));
    value = corrected < 1 ? corrected : 0;  // rounding may reach a whole cycle
  }
}

WiggleHarmonic read_harmonic(const YamlSection& section) {
  section.allow_only({"order", "cosine_m", "sine_m"});
  WiggleHarmonic harmonic;
  harmonic.order = section.value<int>("order", "a whole number");
  if (harmonic.order < 1) section.fail(section.key("order"), "must be at least 1");
  harmonic.cosine_m = section.value<double>("cosine_m", "a number of metres");
  harmonic.sine_m = section.value<double>("sine_m", "a number of metres");
  return harmonic;
}

PhaseError read_error(const YamlSection& root, const std::string& name) {
  PhaseError error;
  if (!root.has(name)) return error;
  const YamlSection section = root.section(name);
  section.allow_only({"offset_m", "harmonics", "table_m"});
  if (section.has("offset_m")) {
    error.offset_m = section.value<double>("offset_m", "a number of metres");
  }
  for (const YamlSection& harmonic : section.list("harmonics")) {
    error.harmonics.push_back(read_harmonic(harmonic));
  }
  if (section.has("table_m")) {
    error.table_m = section.value<std::vector<double>>("table_m", "a list of metres");
  }
  return error;
}

void check_finite(const PhaseError& error, const YamlSection& root, const std::string& name) {
  bool finite = std::isfinite(error.offset_m);
  for (const WiggleHarmonic& one : error.harmonics) {
    finite = finite && std::isfinite(one.cosine_m) && std::isfinite(one.sine_m);
  }
  for (const double value : error.table_m) finite = finite && std::isfinite(value);
  if (!finite) root.fail(name, "must hold finite numbers");
}

void write_error(std::ostream& out, const char* name, const PhaseError& error) {
  out << name << ":\n  offset_m: " << shortest(error.offset_m) << '\n';
  if (!error.harmonics.empty()) out << "  harmonics:\n";
  for (const WiggleHarmonic& harmonic : error.harmonics) {
    out << "    - {order: " << harmonic.order << ", cosine_m: " << shortest(harmonic.cosine_m)
        << ", sine_m: " << shortest(harmonic.sine_m) << "}\n";
  }
  if (error.table_m.empty()) return;
  out << "  table_m: [";
  for (std::size_t i = 0; i < error.table_m.size(); ++i) {
    out << (i == 0 ? "" : ", ") << shortest(error.table_m[i]);
  }
  out << "]\n";
}

}  // namespace

double PhaseError::at_m(double phase_cycles) const {
  double error_m = offset_m;
  for (const WiggleHarmonic& harmonic : harmonics) {
    const double angle = 2 * std::numbers::pi * harmonic.order * phase_cycles;
    error_m += harmonic.cosine_m * std::cos(angle) + harmonic.sine_m * std::sin(angle);
  }
  if (table_m.empty()) return error_m;
  const double place = wrapped(phase_cycles) * static_cast<double>(table_m.size());
  const auto before = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(before);
  return error_m + (1 - share) * table_m[before % table_m.size()] +
         share * table_m[(before + 1) % table_m.size()];
}

CameraCalibration read_calibration(const std::filesystem::path& file) {
  const YamlSection root = load_yaml(file, "'tofmap calibrate' writes such a file");
  check_format(root, format_name, format_version);
  root.allow_only({"format", "version", "camera", "error_a", "error_b", "saturation_amplitude"});
  CameraCalibration calibration;
  if (root.has("camera")) {
    calibration.camera = read_camera(root.section("camera"));
    naming(file.string(), [&] { validate(*calibration.camera); });
  }
  calibration.error_a = read_error(root, "error_a");
  calibration.error_b = read_error(root, "error_b");
  check_finite(calibration.error_a, root, "error_a");
  check_finite(calibration.error_b, root, "error_b");
  if (root.has("saturation_amplitude")) {
    calibration.saturation_amplitude =
        root.value<double>("saturation_amplitude", "an amplitude above 0");
    if (!(calibration.saturation_amplitude > 0)) {
      root.fail("saturation_amplitude", "must be above 0; leave it out if it is not known");
    }
  }
  return calibration;
}

bool is_calibration(const std::filesystem::path& file) {
  try {
    check_format(load_yaml(file, ""), format_name, format_version);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

void write_calibration(const std::filesystem::path& file, const CameraCalibration& calibration,
                       const std::string& comment) {
  std::ofstream out(file);
  if (!comment.empty()) out << "# " << comment << '\n';
  out << "format: " << format_name << "\nversion: " << format_version << '\n';
  if (calibration.camera) out << "camera:\n" << camera_text(*calibration.camera);
  write_error(out, "error_a", calibration.error_a);
  write_error(out, "error_b", calibration.error_b);
  if (calibration.saturation_amplitude > 0) {
    out << "saturation_amplitude: " << shortest(calibration.saturation_amplitude) << '\n';
  }
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written; is the disk full?");
}

SensorModel calibrated(SensorModel sensor, const CameraCalibration& calibration) {
  if (calibration.saturation_amplitude > 0) {
    sensor.saturation_amplitude = calibration.saturation_amplitude;
  }
  if (!calibration.camera) return sensor;
  const CameraModel& given = *calibration.camera;
  if (given.width_px != sensor.camera.width_px || given.height_px != sensor.camera.height_px) {
    const auto size = [](const CameraModel& camera) {
      return std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px);
    };
    throw InputError("the calibration is of a camera of " + size(given) +
                     " pixels, the recording's has " + size(sensor.camera) +
                     "; is it of another camera?");
  }
  sensor.camera = *calibration.camera;
  return sensor;
}

void calibrate(DualFrequencyFrame& frame, const Modulation& modulation,
               const CameraCalibration& calibration) {
  correct(frame.phase_a, calibration.error_a, modulation.wavelength_a_m());
  correct(frame.phase_b, calibration.error_b, modulation.wavelength_b_m());
}

}  // namespace tofmap

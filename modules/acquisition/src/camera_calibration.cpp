// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/camera_calibration.hpp"

#include "yaml_section.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

constexpr const char* calibration_format = "tofmap-camera";

/// Version 1 has two frequencies, version 2 any number.
constexpr int calibration_version_of_pairs = 1;
constexpr int latest_calibration_version = 2;

constexpr const char* pattern_key = "fixed_pattern";
constexpr const char* pattern_name_expected =
    "the name of a .npy file in the folder of the calibration";

/// The key of the error at a frequency: "error_a" for the first one.
std::string error_key(std::size_t frequency) {
  return std::string("error_") + frequency_letter(frequency);
}

double wrapped(double cycles) { return cycles - std::floor(cycles); }

/// True if the error is 0 at every phase.
bool is_nothing(const PhaseError& error) {
  return error.offset_m == 0 && error.harmonics.empty() && error.table_m.empty();
}

/// Number of phases at which the error is tabulated. No camera's error needs a finer table.
constexpr int steps_a_cycle = 4096;

/// Subtracts the error from the phases of one frequency.
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
    value = corrected < 1 ? corrected : 0;  // rounding may give a whole cycle
  }
}

/// No cable delay causes a larger offset, and up to it phases keep a precision of 0.01 mm.
constexpr double longest_offset_m = 100;

/// Up to this order the error is smooth between the steps of its table.
constexpr int highest_order = 64;

/// Amplitudes have 16 bits.
constexpr double highest_amplitude = 65535;

WiggleHarmonic read_harmonic(const YamlSection& section) {
  section.allow_only({"order", "cosine_m", "sine_m"});
  WiggleHarmonic harmonic;
  harmonic.order = section.value<int>("order", "a whole number");
  if (harmonic.order < 1 || harmonic.order > highest_order) {
    section.fail(section.key("order"), "must be 1 to " + std::to_string(highest_order));
  }
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
    if (std::abs(error.offset_m) > longest_offset_m) {
      section.fail(section.key("offset_m"), "must be between -100 and 100 m");
    }
  }
  std::set<int> orders;
  for (const YamlSection& harmonic : section.list("harmonics")) {
    error.harmonics.push_back(read_harmonic(harmonic));
    if (!orders.insert(error.harmonics.back().order).second) {
      section.fail(section.key("harmonics"),
                   "list order " + std::to_string(error.harmonics.back().order) + " twice");
    }
  }
  if (section.has("table_m")) {
    error.table_m = section.value<std::vector<double>>("table_m", "a list of metres");
  }
  return error;
}

/// Throws InputError if the error rises faster than the phase anywhere: a longer range would
/// measure shorter there.
void check_order(const PhaseError& error, const std::string& name, double wavelength_m) {
  for (int i = 0; i < steps_a_cycle; ++i) {
    const double step_m =
        error.at_m((i + 1.0) / steps_a_cycle) - error.at_m(1.0 * i / steps_a_cycle);
    if (step_m < wavelength_m / steps_a_cycle) continue;
    std::ostringstream message;
    message << name << " rises faster than the phase, at " << 1.0 * i / steps_a_cycle
            << " of its cycle of " << wavelength_m
            << " m, which no camera's error does; is it in metres, and of this camera?";
    throw InputError(message.str());
  }
}

CalibratedWith read_calibrated_with(const YamlSection& section, int version) {
  CalibratedWith with;
  with.width_px = section.value<int>("width", "a number of pixels");
  with.height_px = section.value<int>("height", "a number of pixels");
  if (version == calibration_version_of_pairs) {
    section.allow_only({"width", "height", "frequency_a_hz", "frequency_b_hz"});
    with.modulation = {section.value<double>("frequency_a_hz", "a frequency in Hz"),
                       section.value<double>("frequency_b_hz", "a frequency in Hz")};
  } else {
    section.allow_only({"width", "height", "frequencies_hz"});
    with.modulation.frequencies_hz =
        section.value<std::vector<double>>("frequencies_hz", "a list of frequencies in Hz");
  }
  return with;
}

void write_error(std::ostream& out, const std::string& name, const PhaseError& error) {
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

std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + " x " + std::to_string(height_px) + " pixels";
}

std::string frequencies_text(const Modulation& modulation) {
  std::vector<std::string> numbers;
  for (const double hz : modulation.frequencies_hz) {
    numbers.push_back(fmt::format("{:.9g}", hz / 1e6));
  }
  return joined(numbers, " and ") + " MHz";
}

[[noreturn]] void refuse_other_camera(const std::string& calibrated, const std::string& recorded) {
  throw InputError("is for a camera with " + calibrated + ", but the recording has " + recorded +
                   "; does it belong to another camera?");
}

void check_size(int width_px, int height_px, const CameraModel& camera) {
  if (width_px == camera.width_px && height_px == camera.height_px) return;
  refuse_other_camera(size_text(width_px, height_px), size_text(camera.width_px, camera.height_px));
}

void check_camera(const CalibratedWith& with, const SensorModel& sensor) {
  check_size(with.width_px, with.height_px, sensor.camera);
  constexpr double same = 1e-4;  // tolerance of the oscillator and of rounding
  const auto is_same = [](double one_hz, double other_hz) {
    return std::abs(one_hz - other_hz) <= same * other_hz;
  };
  if (std::ranges::equal(with.modulation.frequencies_hz, sensor.modulation.frequencies_hz,
                         is_same)) {
    return;
  }
  refuse_other_camera(frequencies_text(with.modulation), frequencies_text(sensor.modulation));
}

/// The comment as one line of valid YAML. It may quote file names, which can contain line breaks
/// and bytes that are not UTF-8.
std::string one_line(const std::string& comment) {
  std::string line = valid_utf8(comment);
  std::ranges::replace_if(
      line, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return line;
}

/// The name of a file beside the calibration. Throws InputError if it is a path.
std::string read_pattern_name(const YamlSection& root) {
  const auto name = root.value<std::string>(pattern_key, pattern_name_expected);
  const std::filesystem::path path(name);
  if (path != path.filename() || path.extension() != ".npy") {
    root.fail(pattern_key,
              std::string("must be ") + pattern_name_expected + ", not '" + name + "'");
  }
  return name;
}

/// Reads the pattern that a calibration names.
FixedPattern read_named_pattern(const CameraCalibration& calibration) {
  // A link to a calibration stands for the file that it leads to.
  const std::filesystem::path folder =
      std::filesystem::weakly_canonical(calibration.file).parent_path();
  const std::filesystem::path file = folder / calibration.fixed_pattern_file;
  FixedPattern pattern = read_fixed_pattern(file);
  if (calibration.with) {
    const CalibratedWith& with = *calibration.with;
    naming(file.string(), [&] {
      check_fixed_pattern(pattern, with.modulation.count(), with.width_px, with.height_px);
    });
  }
  return pattern;
}

SensorModel with_calibration(SensorModel sensor, const CameraCalibration& calibration) {
  if (calibration.saturation_amplitude > 0) {
    sensor.saturation_amplitude = calibration.saturation_amplitude;
  }
  if (calibration.with) check_camera(*calibration.with, sensor);
  const Modulation& modulation = sensor.modulation;
  for (std::size_t f = 0; f < calibration.errors.size(); ++f) {
    if (f < modulation.count()) {
      check_order(calibration.errors[f], error_key(f), modulation.wavelength_m(f));
    } else if (!is_nothing(calibration.errors[f])) {
      throw InputError(error_key(f) + " is of frequency " + std::to_string(f + 1) +
                       ", but the recording has " +
                       counted(modulation.count(), "frequency", "frequencies") +
                       "; does it belong to another camera?");
    }
  }
  check_fixed_pattern(calibration.fixed_pattern, modulation.count(), sensor.camera.width_px,
                      sensor.camera.height_px);
  if (!calibration.camera) return sensor;
  const CameraModel& given = *calibration.camera;
  check_size(given.width_px, given.height_px, sensor.camera);
  sensor.camera = *calibration.camera;
  return sensor;
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
  const int version = check_format(root, calibration_format, latest_calibration_version);
  root.allow_only({"format", "version", "calibrated_with", "camera", "error_a", "error_b",
                   "error_c", "error_d", "error_e", "error_f", "error_g", "error_h",
                   "saturation_amplitude", pattern_key});
  CameraCalibration calibration;
  calibration.file = file;
  if (root.has("calibrated_with")) {
    calibration.with = read_calibrated_with(root.section("calibrated_with"), version);
    naming(file.string(), [&] { validate(calibration.with->modulation); });
  }
  if (root.has("camera")) {
    calibration.camera = read_camera(root.section("camera"));
    naming(file.string(), [&] { validate(*calibration.camera); });
  }
  for (std::size_t f = 0; f < most_frequencies; ++f) {
    if (!root.has(error_key(f))) continue;
    calibration.errors.resize(f + 1);
    calibration.errors[f] = read_error(root, error_key(f));
  }
  if (root.has("saturation_amplitude")) {
    calibration.saturation_amplitude =
        root.value<double>("saturation_amplitude", "an amplitude above 0");
    if (!(calibration.saturation_amplitude > 0 &&
          calibration.saturation_amplitude <= highest_amplitude)) {
      root.fail("saturation_amplitude",
                "must be above 0 and at most 65535; leave it out if it is not known");
    }
  }
  if (root.has(pattern_key)) {
    calibration.fixed_pattern_file = read_pattern_name(root);
    calibration.fixed_pattern = read_named_pattern(calibration);
  }
  return calibration;
}

bool is_calibration(const std::filesystem::path& file) {
  try {
    check_format(load_yaml(file, ""), calibration_format, latest_calibration_version);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::string fixed_pattern_file_in(const std::filesystem::path& file) {
  try {
    const YamlSection root = load_yaml(file, "");
    check_format(root, calibration_format, latest_calibration_version);
    return root.has(pattern_key) ? read_pattern_name(root) : "";
  } catch (const InputError&) {
    return "";
  }
}

void write_calibration(const std::filesystem::path& file, const CameraCalibration& calibration,
                       const std::string& comment) {
  std::ofstream out(file);
  if (!comment.empty()) out << "# " << one_line(comment) << '\n';
  const bool is_pair =
      calibration.with ? calibration.with->modulation.count() == 2 : calibration.errors.size() <= 2;
  out << "format: " << calibration_format
      << "\nversion: " << (is_pair ? calibration_version_of_pairs : latest_calibration_version)
      << '\n';
  if (calibration.with) {
    const CalibratedWith& with = *calibration.with;
    const std::vector<double>& hz = with.modulation.frequencies_hz;
    out << "calibrated_with: {width: " << with.width_px << ", height: " << with.height_px;
    if (is_pair) {
      out << ", frequency_a_hz: " << shortest(hz[0]) << ", frequency_b_hz: " << shortest(hz[1]);
    } else {
      out << ", frequencies_hz: " << list_text(hz);
    }
    out << "}\n";
  }
  if (calibration.camera) out << "camera:\n" << camera_text(*calibration.camera);
  for (std::size_t f = 0; f < calibration.errors.size(); ++f) {
    write_error(out, error_key(f), calibration.errors[f]);
  }
  if (!calibration.fixed_pattern_file.empty()) {
    out << pattern_key << ": " << YAML::Dump(YAML::Node(calibration.fixed_pattern_file)) << '\n';
  }
  if (calibration.saturation_amplitude > 0) {
    out << "saturation_amplitude: " << shortest(calibration.saturation_amplitude) << '\n';
  }
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written; is the disk full?");
}

SensorModel calibrated(const SensorModel& sensor, const CameraCalibration& calibration) {
  const std::string origin =
      calibration.file.empty() ? "the calibration" : calibration.file.string();
  return naming(origin, [&] { return with_calibration(sensor, calibration); });
}

void calibrate(Frame& frame, const Modulation& modulation, const CameraCalibration& calibration) {
  subtract_fixed_pattern(frame, modulation, calibration.fixed_pattern);
  const std::size_t known = std::min(calibration.errors.size(), frame.frequencies());
  for (std::size_t f = 0; f < known; ++f) {
    correct(frame.phases[f], calibration.errors[f], modulation.wavelength_m(f));
  }
}

}  // namespace tofmap

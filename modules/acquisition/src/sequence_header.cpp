// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sequence_header.hpp"

#include "yaml_section.hpp"

#include <cmath>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

constexpr const char* sequence_format = "tofmap-sequence";
constexpr int sequence_version = 1;

Modulation read_modulation(const YamlSection& section) {
  section.allow_only({"frequency_a_hz", "frequency_b_hz"});
  return {section.value<double>("frequency_a_hz", "a number of hertz"),
          section.value<double>("frequency_b_hz", "a number of hertz")};
}

SensorModel read_sensor(const YamlSection& root) {
  check_format(root, sequence_format, sequence_version);
  root.allow_only({"format", "version", "camera", "modulation", "max_range_m"});
  SensorModel sensor;
  sensor.camera = read_camera(root.section("camera"));
  sensor.modulation = read_modulation(root.section("modulation"));
  if (root.has("max_range_m")) {
    sensor.max_range_m = root.value<double>("max_range_m", "a number of metres");
    if (!(std::isfinite(sensor.max_range_m) && sensor.max_range_m > 0)) {
      root.fail("max_range_m", "must be above 0; leave it out if it is not known");
    }
  }
  return sensor;
}

}  // namespace

SensorModel read_sequence_header(const std::filesystem::path& file) {
  const SensorModel sensor =
      read_sensor(load_yaml(file, "a sequence folder holds sequence.yaml and frames.txt"));
  naming(file.string(), [&] {
    validate(sensor.camera);
    validate(sensor.modulation);
    const double most_m = invalid_wrap_count * sensor.modulation.wavelength_a_m();
    if (sensor.max_range_m <= most_m) return;
    throw InputError("max_range_m must be at most " + std::to_string(invalid_wrap_count) +
                     " wavelengths of A, " + shortest(most_m) + " m");
  });
  return sensor;
}

std::string sequence_header_text(const SensorModel& sensor) {
  std::string text =
      std::string("format: ") + sequence_format + "\nversion: " + std::to_string(sequence_version) +
      "\ncamera:\n" + camera_text(sensor.camera) +
      "modulation:\n  frequency_a_hz: " + shortest(sensor.modulation.frequency_a_hz) +
      "\n  frequency_b_hz: " + shortest(sensor.modulation.frequency_b_hz) + '\n';
  if (sensor.max_range_m > 0) text += "max_range_m: " + shortest(sensor.max_range_m) + '\n';
  return text;
}

}  // namespace tofmap

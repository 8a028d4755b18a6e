// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sequence_header.hpp"

#include "range_limit.hpp"
#include "yaml_section.hpp"

#include <cmath>

namespace tofmap {
namespace {

constexpr const char* sequence_format = "tofmap-sequence";

/// Version 1 has two frequencies, version 2 any number.
constexpr int sequence_version_of_pairs = 1;
constexpr int latest_sequence_version = 2;

Modulation read_frequencies(const YamlSection& section) {
  section.allow_only({"frequencies_hz", "exposure_offsets_s"});
  Modulation modulation;
  modulation.frequencies_hz =
      section.value<std::vector<double>>("frequencies_hz", "a list of hertz");
  if (section.has("exposure_offsets_s")) {
    modulation.exposure_offsets_s =
        section.value<std::vector<double>>("exposure_offsets_s", "a list of seconds");
  }
  return modulation;
}

Modulation read_pair(const YamlSection& section) {
  section.allow_only({"frequency_a_hz", "frequency_b_hz"});
  return {section.value<double>("frequency_a_hz", "a number of hertz"),
          section.value<double>("frequency_b_hz", "a number of hertz")};
}

SensorModel read_sensor(const YamlSection& root) {
  const int version = check_format(root, sequence_format, latest_sequence_version);
  root.allow_only({"format", "version", "camera", "modulation", "max_range_m"});
  SensorModel sensor;
  sensor.camera = read_camera(root.section("camera"));
  const YamlSection modulation = root.section("modulation");
  sensor.modulation =
      version == sequence_version_of_pairs ? read_pair(modulation) : read_frequencies(modulation);
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
    const std::string fault = range_limit_fault(sensor.max_range_m, sensor.modulation);
    if (!fault.empty()) throw InputError("max_range_m " + fault);
  });
  return sensor;
}

std::string sequence_header_text(const SensorModel& sensor) {
  const Modulation& modulation = sensor.modulation;
  const bool is_pair = modulation.count() == 2;
  std::string text = std::string("format: ") + sequence_format + "\nversion: " +
                     std::to_string(is_pair ? sequence_version_of_pairs : latest_sequence_version) +
                     "\ncamera:\n" + camera_text(sensor.camera) + "modulation:\n";
  if (is_pair) {
    text += "  frequency_a_hz: " + shortest(modulation.frequencies_hz[0]) +
            "\n  frequency_b_hz: " + shortest(modulation.frequencies_hz[1]) + '\n';
  } else {
    text += "  frequencies_hz: " + list_text(modulation.frequencies_hz) + '\n';
    if (!modulation.exposure_offsets_s.empty()) {
      text += "  exposure_offsets_s: " + list_text(modulation.exposure_offsets_s) + '\n';
    }
  }
  if (sensor.max_range_m > 0) text += "max_range_m: " + shortest(sensor.max_range_m) + '\n';
  return text;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sequence_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <sstream>
#include <string_view>

#include <yaml-cpp/yaml.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr const char* format_name = "tofmap-sequence";
constexpr int format_version = 1;
constexpr int max_side_px = 16384;

/// A YAML map that knows where it stands, so that every complaint names file and key.
class Section {
 public:
  Section(const std::filesystem::path& file, std::string name, const YAML::Node& node)
      : file_(file), name_(std::move(name)), node_(node) {
    if (!node_.IsMap()) fail(name_.empty() ? "the file" : name_, "must be a map of keys");
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw InputError(file_.string() + ": " + key + " " + what);
  }

  std::string key(const std::string& name) const {
    return name_.empty() ? name : name_ + "." + name;
  }

  bool has(const std::string& name) const { return static_cast<bool>(node_[name]); }

  Section section(const std::string& name) const {
    if (!has(name)) fail(key(name), "is missing");
    return {file_, key(name), node_[name]};
  }

  template <class T>
  T value(const std::string& name, const char* expected) const {
    if (!has(name)) fail(key(name), std::string("is missing; it must be ") + expected);
    return convert<T>(node_[name], key(name), expected);
  }

  template <class T, std::size_t n>
  std::array<T, n> values(const std::string& name, const char* expected) const {
    const YAML::Node list = node_[name];
    if (!list.IsSequence() || list.size() != n) {
      fail(key(name), std::string("must be ") + expected);
    }
    std::array<T, n> result{};
    for (std::size_t i = 0; i < n; ++i) result[i] = convert<T>(list[i], key(name), expected);
    return result;
  }

  /// A misspelt key would otherwise be silently without effect.
  void allow_only(std::initializer_list<std::string_view> names) const {
    std::string known;
    for (const std::string_view name : names) {
      known += (known.empty() ? "" : ", ") + std::string(name);
    }
    for (const auto& entry : node_) {
      const auto name = entry.first.as<std::string>();
      if (std::ranges::find(names, name) == names.end()) {
        fail(key(name), "is an unknown key; known here: " + known);
      }
    }
  }

 private:
  template <class T>
  T convert(const YAML::Node& node, const std::string& name, const char* expected) const {
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      const std::string given = node.IsScalar() ? ", not '" + node.Scalar() + "'" : "";
      fail(name, std::string("must be ") + expected + given);
    }
  }

  std::filesystem::path file_;
  std::string name_;
  YAML::Node node_;
};

void check_format(const Section& root) {
  const auto format = root.value<std::string>("format", format_name);
  if (format != format_name) {
    root.fail("format", "is '" + format + "'; only '" + format_name + "' can be read");
  }
  const int version = root.value<int>("version", "a whole number");
  if (version != format_version) {
    root.fail("version", "is " + std::to_string(version) + "; this program reads version " +
                             std::to_string(format_version));
  }
}

CameraModel read_camera(const Section& section) {
  section.allow_only({"width", "height", "fx", "fy", "cx", "cy", "distortion"});
  constexpr const char* pixels = "a number of pixels";
  CameraModel camera;
  camera.width_px = section.value<int>("width", "a whole number of pixels");
  camera.height_px = section.value<int>("height", "a whole number of pixels");
  if (camera.width_px > max_side_px || camera.height_px > max_side_px) {
    section.fail(section.key("width and height"),
                 "must be at most " + std::to_string(max_side_px) + " pixels");
  }
  camera.fx_px = section.value<double>("fx", pixels);
  camera.fy_px = section.value<double>("fy", pixels);
  camera.cx_px = section.value<double>("cx", pixels);
  camera.cy_px = section.value<double>("cy", pixels);
  if (section.has("distortion")) {
    camera.distortion = section.values<double, 5>("distortion", "five numbers: k1 k2 p1 p2 k3");
  }
  return camera;
}

Modulation read_modulation(const Section& section) {
  section.allow_only({"frequency_a_hz", "frequency_b_hz"});
  return {section.value<double>("frequency_a_hz", "a number of hertz"),
          section.value<double>("frequency_b_hz", "a number of hertz")};
}

SensorModel read_sensor(const Section& root) {
  check_format(root);
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

std::string shortest(double number) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, number).ptr;
  return {buffer, end};
}

}  // namespace

SensorModel read_sequence_header(const std::filesystem::path& file) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(file.string());
  } catch (const YAML::BadFile&) {
    throw InputError(file.string() +
                     ": cannot be read; a sequence folder holds sequence.yaml and frames.txt");
  } catch (const YAML::Exception& error) {
    throw InputError(file.string() + ": no valid YAML: " + error.what());
  }
  const SensorModel sensor = read_sensor(Section(file, "", root));
  try {
    validate(sensor.camera);
    validate(sensor.modulation);
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  return sensor;
}

std::string sequence_header_text(const SensorModel& sensor) {
  const CameraModel& camera = sensor.camera;
  std::ostringstream out;
  out << "format: " << format_name << "\nversion: " << format_version << "\ncamera:\n"
      << "  width: " << camera.width_px << "\n  height: " << camera.height_px
      << "\n  fx: " << shortest(camera.fx_px) << "\n  fy: " << shortest(camera.fy_px)
      << "\n  cx: " << shortest(camera.cx_px) << "\n  cy: " << shortest(camera.cy_px)
      << "\n  distortion: [";
  for (std::size_t i = 0; i < camera.distortion.size(); ++i) {
    out << (i == 0 ? "" : ", ") << shortest(camera.distortion[i]);
  }
  out << "]  # k1 k2 p1 p2 k3\nmodulation:\n"
      << "  frequency_a_hz: " << shortest(sensor.modulation.frequency_a_hz)
      << "\n  frequency_b_hz: " << shortest(sensor.modulation.frequency_b_hz) << '\n';
  if (sensor.max_range_m > 0) out << "max_range_m: " << shortest(sensor.max_range_m) << '\n';
  return out.str();
}

}  // namespace tofmap

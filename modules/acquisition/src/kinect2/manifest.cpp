// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "manifest.hpp"

#include "binary_file.hpp"
#include "recorded_path.hpp"
#include "shown_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

#include <fmt/format.h>

#include <tofmap/acquisition/kinect2/intrinsics.hpp>
#include <tofmap/acquisition/kinect2/packet.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap::kinect2 {
namespace {

// Manifests are read as unordered JSON: ordered JSON copies its values when it grows, one call a
// level, so that values which nest too deeply overflow the stack.
using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr std::size_t most_bytes = 1U << 20U;
constexpr const char* depth_encoding = "kinect-v2-raw";
constexpr const char* device_clock = "kinect-v2-0.125ms-wrap32";
constexpr const char* arrival_clock = "monotonic-host-microseconds-relative-to-recording-start";

/// The names and members of the infrared camera's intrinsics.
struct NamedIntrinsic {
  const char* name;
  double Intrinsics::*member;
};
constexpr std::array<NamedIntrinsic, 9> intrinsic_names{{{"fx", &Intrinsics::fx},
                                                         {"fy", &Intrinsics::fy},
                                                         {"cx", &Intrinsics::cx},
                                                         {"cy", &Intrinsics::cy},
                                                         {"k1", &Intrinsics::k1},
                                                         {"k2", &Intrinsics::k2},
                                                         {"k3", &Intrinsics::k3},
                                                         {"p1", &Intrinsics::p1},
                                                         {"p2", &Intrinsics::p2}}};

/// The keys of the color camera's intrinsics.
constexpr std::array color_names{"fx",      "fy",      "cx",      "cy",      "shift_d", "shift_m",
                                 "mx_x3y0", "mx_x0y3", "mx_x2y1", "mx_x1y2", "mx_x2y0", "mx_x0y2",
                                 "mx_x1y1", "mx_x1y0", "mx_x0y1", "mx_x0y0", "my_x3y0", "my_x0y3",
                                 "my_x2y1", "my_x1y2", "my_x2y0", "my_x0y2", "my_x1y1", "my_x1y0",
                                 "my_x0y1", "my_x0y0"};

/// Parses JSON. Throws InputError, which names the line of a mistake.
Json parsed(const std::vector<std::uint8_t>& bytes) {
  try {
    return Json::parse(bytes);
  } catch (const Json::parse_error& error) {
    const auto end =
        bytes.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, bytes.size()));
    const auto line = 1 + std::count(bytes.begin(), end, '\n');
    throw InputError("line " + std::to_string(line) + " is not valid JSON; is the file damaged?");
  } catch (const Json::exception&) {
    throw InputError("holds a number that is too large");
  }
}

/// The value at a path of keys. Empty if there is none.
const Json* find(const Json& root, std::initializer_list<const char*> keys) {
  const Json* value = &root;
  for (const char* key : keys) {
    const auto child = value->is_object() ? value->find(key) : value->end();
    if (child == value->end()) return nullptr;
    value = &*child;
  }
  return value;
}

/// The text at a path of keys. Empty if there is none.
std::string text_at(const Json& root, std::initializer_list<const char*> keys) {
  const Json* value = find(root, keys);
  return value != nullptr && value->is_string() ? value->get<std::string>() : "";
}

/// Throws InputError if the value at a path of keys is given, but not as expected.
void expect_text(const Json& root, std::initializer_list<const char*> keys, const char* name,
                 const char* expected) {
  const Json* value = find(root, keys);
  if (value == nullptr || (value->is_string() && value->get<std::string>() == expected)) return;
  throw InputError(std::string(name) + " must be '" + expected + "', got " + shown(*value));
}

void check_version(const Json& root) {
  const Json* version = find(root, {"version"});
  if (version == nullptr) throw InputError("version is missing");
  if (!version->is_number_integer() || (*version != 1 && *version != 2)) {
    throw InputError("version must be 1 or 2, got " + shown(*version));
  }
}

/// Throws InputError, which names the key, if a value is impossible for a Kinect v2.
void check_intrinsic(const std::string& name, double value) {
  const std::string key = "calibration.ir." + name;
  const bool is_focal = name == "fx" || name == "fy";
  if (is_focal && !is_possible_focal_length(value)) {
    throw InputError(fmt::format(
        "{} must be from 200 to 600 pixels, as that of a Kinect v2 is about 365, got {}", key,
        value));
  }
  const double most = name == "cx" ? image_width_px : image_height_px;
  if ((name == "cx" || name == "cy") && !(value >= 0 && value <= most)) {
    throw InputError(key + " must be in the image, from 0 to " +
                     std::to_string(static_cast<int>(most)) + ", got " + std::to_string(value));
  }
}

CameraModel read_camera(const Json& root) {
  Intrinsics intrinsics;
  for (const auto& [name, member] : intrinsic_names) {
    const Json* value = find(root, {"calibration", "ir", name});
    const std::string key = std::string("calibration.ir.") + name;
    if (value == nullptr) throw InputError(key + " is missing");
    if (!value->is_number() || !std::isfinite(value->get<double>())) {
      throw InputError(key + " must be a number, got " + shown(*value));
    }
    check_intrinsic(name, value->get<double>());
    intrinsics.*member = value->get<double>();
  }
  const CameraModel camera = camera_of(intrinsics);
  naming("calibration.ir", [&] { return validate(camera); });
  return camera;
}

}  // namespace

Manifest read_manifest(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file, most_bytes);
  return naming(file.string(), [&] {
    if (bytes.size() > most_bytes) throw InputError("is too large for a manifest");
    const Json root = parsed(bytes);
    check_version(root);
    expect_text(root, {"streams", "depth", "encoding"}, "streams.depth.encoding", depth_encoding);
    expect_text(root, {"clocks", "device"}, "clocks.device", device_clock);
    Manifest manifest;
    manifest.serial = text_at(root, {"device", "serial"});
    manifest.firmware = text_at(root, {"device", "firmware"});
    manifest.camera = read_camera(root);
    if (find(root, {"calibration", "p0"}) != nullptr) {
      manifest.p0 = naming("calibration.p0", [&] {
        return recorded_path(text_at(root, {"calibration", "p0"}));
      });
    }
    return manifest;
  });
}

std::string manifest_text(const Manifest& manifest) {
  const Intrinsics intrinsics = intrinsics_of(manifest.camera);
  OrderedJson infrared;
  for (const auto& [name, member] : intrinsic_names) infrared[name] = intrinsics.*member;
  OrderedJson color;
  for (const char* name : color_names) color[name] = 0.0;
  const OrderedJson root = {
      {"version", 2},
      {"device", {{"serial", manifest.serial}, {"firmware", manifest.firmware}}},
      {"streams", {{"color", {{"encoding", "jpeg"}}}, {"depth", {{"encoding", depth_encoding}}}}},
      {"calibration", {{"color", color}, {"ir", infrared}, {"p0", manifest.p0.generic_string()}}},
      {"clocks", {{"device", device_clock}, {"arrival", arrival_clock}}}};
  return root.dump(2) + "\n";
}

}  // namespace tofmap::kinect2

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml_section.hpp"

#include "tofmap/acquisition/png_image.hpp"

#include <sstream>

#include <tofmap/core/input_file.hpp>

namespace tofmap {

YamlSection load_yaml(const std::filesystem::path& file, const std::string& hint) {
  refuse_no_file(file);
  try {
    return {file, "", YAML::LoadFile(file.string())};
  } catch (const YAML::BadFile&) {
    throw InputError(file.string() + ": cannot be read; " + hint);
  } catch (const YAML::Exception& error) {
    throw InputError(file.string() + ": is not valid YAML: " + error.what());
  }
}

int check_format(const YamlSection& root, const std::string& format, int latest_version) {
  const auto given = root.value<std::string>("format", format.c_str());
  if (given != format) {
    root.fail("format", "is '" + given + "'; only '" + format + "' can be read");
  }
  const auto version = root.value<int>("version", "a whole number");
  if (version < 1 || version > latest_version) {
    const std::string latest = std::to_string(latest_version);
    root.fail("version", "is " + std::to_string(version) + "; this program reads version" +
                             (latest_version == 1 ? " 1" : "s 1 to " + latest));
  }
  return version;
}

CameraModel read_camera(const YamlSection& section) {
  section.allow_only({"width", "height", "fx", "fy", "cx", "cy", "distortion"});
  constexpr const char* pixels = "a number of pixels";
  CameraModel camera;
  camera.width_px = section.value<int>("width", "a whole number of pixels");
  camera.height_px = section.value<int>("height", "a whole number of pixels");
  if (camera.width_px > max_image_side_px || camera.height_px > max_image_side_px) {
    section.fail(section.key("width and height"),
                 "must be at most " + std::to_string(max_image_side_px) + " pixels");
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

std::string camera_text(const CameraModel& camera) {
  std::ostringstream out;
  out << "  width: " << camera.width_px << "\n  height: " << camera.height_px
      << "\n  fx: " << shortest(camera.fx_px) << "\n  fy: " << shortest(camera.fy_px)
      << "\n  cx: " << shortest(camera.cx_px) << "\n  cy: " << shortest(camera.cy_px)
      << "\n  distortion: [";
  for (std::size_t i = 0; i < camera.distortion.size(); ++i) {
    out << (i == 0 ? "" : ", ") << shortest(camera.distortion[i]);
  }
  out << "]  # k1 k2 p1 p2 k3\n";
  return out.str();
}

}  // namespace tofmap

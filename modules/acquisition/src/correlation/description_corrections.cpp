// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "description_section.hpp"

#include <algorithm>
#include <string_view>

#include <tofmap/core/modulation.hpp>

namespace tofmap {
namespace {

/// The keys of array files that are no frames, and `more`.
void allow_still_keys(const YamlSection& section, std::string_view more) {
  section.allow_only({"files", "axes", "images", "type", "byte_order", "byte_offset", "member",
                      "frequency_names", "step_names", "reshape", more});
}

void refuse_frames(const YamlSection& section, const ArrayFiles& files) {
  const bool in_name = files.pattern.find("{frame") != std::string::npos;
  if (!in_name && std::ranges::count(files.axes, ArrayAxis::frame) == 0) return;
  section.fail(section.key(in_name ? "files" : "axes"), "must not have 'frame'");
}

/// Reads array files that hold an image for each frequency and step, or for several at once.
ArrayFiles read_still_files(const YamlSection& section, ArraySizes sizes) {
  const auto has = [&](const std::string& name) {
    const auto axes = section.value<std::vector<std::string>>("axes", "a list of axes");
    const auto pattern = section.value<std::string>("files", "the name of a file");
    return std::ranges::count(axes, name) > 0 || pattern.find("{" + name) != std::string::npos;
  };
  const bool has_images = has("image");
  if (!has_images && !has("frequency")) sizes.frequencies = 1;
  if (!has_images && !has("step")) sizes.steps = 1;
  ArrayFiles files = read_array_files(section, sizes);
  refuse_frames(section, files);
  return files;
}

}  // namespace

DarkLevel read_dark(const YamlSection& section, const ArraySizes& sizes) {
  allow_still_keys(section, "value");
  DarkLevel dark;
  if (section.has("value") == section.has("files")) {
    section.fail(section.key("value"), "or files must be given, and not both");
  }
  if (section.has("value")) dark.value = section.value<double>("value", "a number");
  if (section.has("files")) dark.files = read_still_files(section, sizes);
  return dark;
}

PhaseOffsets read_phase_offsets(const YamlSection& section, ArraySizes sizes,
                                const std::vector<double>& frequencies_hz) {
  section.allow_only({"cycles", "metres", "per_pixel"});
  PhaseOffsets offsets;
  const bool in_metres = section.has("metres");
  if (in_metres && section.has("cycles")) {
    section.fail(section.key("cycles"), "and metres cannot be given both");
  }
  offsets.cycles.assign(frequencies_hz.size(), 0);
  if (in_metres || section.has("cycles")) {
    const char* name = in_metres ? "metres" : "cycles";
    offsets.cycles =
        section.value<std::vector<double>>(name, "a list of numbers, one per frequency");
    check_count(section, name, offsets.cycles.size(), frequencies_hz.size(), "frequencies");
  }
  for (std::size_t i = 0; in_metres && i < offsets.cycles.size(); ++i) {
    offsets.cycles[i] *= 2 * frequencies_hz[i] / speed_of_light_m_per_s;
  }
  if (!section.has("per_pixel")) return offsets;
  const YamlSection images = section.section("per_pixel");
  allow_still_keys(images, "unit");
  sizes.steps = 1;
  offsets.files = read_still_files(images, sizes);
  offsets.file_unit = word_of<PhaseUnit>(images, "unit",
                                         {{"cycles", PhaseUnit::cycles},
                                          {"radians", PhaseUnit::radians},
                                          {"metres", PhaseUnit::metres}});
  return offsets;
}

}  // namespace tofmap

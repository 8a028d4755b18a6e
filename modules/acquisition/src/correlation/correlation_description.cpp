// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/correlation/correlation_description.hpp"

#include "description_section.hpp"
#include "range_limit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tofmap/core/error.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {
namespace {

constexpr const char* description_format = "tofmap-correlation";
constexpr int description_version = 1;
constexpr std::size_t most_step_angles = 64;

std::vector<double> read_frequencies(const YamlSection& root) {
  constexpr const char* name = "frequencies_hz";
  auto frequencies = root.value<std::vector<double>>(name, "a list of frequencies in hertz");
  Modulation modulation;
  modulation.frequencies_hz = frequencies;
  naming(root.file().string(), [&] { validate(modulation); });
  return frequencies;
}

/// Step angles in radians, one list per frequency.
std::vector<std::vector<double>> read_angles(const YamlSection& root, std::size_t frequencies) {
  const bool in_degrees = root.has("step_angles_deg");
  const char* name = in_degrees ? "step_angles_deg" : "step_angles_rad";
  constexpr const char* expected = "a list of angles, or a list of such lists, one per frequency";
  if (in_degrees == root.has("step_angles_rad")) {
    root.fail("step_angles_deg",
              std::string("or step_angles_rad must be given, and not both: ") + expected);
  }
  std::vector<std::vector<double>> angles;
  if (root.has_nested_list(name)) {
    angles = root.value<std::vector<std::vector<double>>>(name, expected);
    check_count(root, name, angles.size(), frequencies, "frequencies");
  } else {
    angles.assign(frequencies, root.value<std::vector<double>>(name, expected));
  }
  for (std::vector<double>& of_frequency : angles) {
    if (of_frequency.size() > most_step_angles) {
      root.fail(name, "has more than " + std::to_string(most_step_angles) + " steps");
    }
    constexpr double most_rad = 4 * std::numbers::pi;
    for (double& angle : of_frequency) {
      if (!in_degrees && std::abs(angle) > most_rad) {
        root.fail(name, "has " + shortest(angle) +
                            ", more than two turns; give degrees as step_angles_deg");
      }
      angle *= in_degrees ? std::numbers::pi / 180 : 1;
    }
  }
  return angles;
}

std::vector<StepDesign> read_designs(const YamlSection& root, std::size_t frequencies) {
  const bool with_offset =
      !root.has("offset") || word_of<bool>(root, "offset", {{"fitted", true}, {"none", false}});
  const int sign = root.value<int>("phase_sign", "1 or -1");
  if (sign != 1 && sign != -1) {
    root.fail("phase_sign", "must be 1 or -1, not " + std::to_string(sign));
  }
  std::vector<StepDesign> designs;
  for (std::vector<double>& angles : read_angles(root, frequencies)) {
    try {
      designs.emplace_back(std::move(angles), with_offset, sign);
    } catch (const InputError& error) {
      root.fail(root.has("step_angles_deg") ? "step_angles_deg:" : "step_angles_rad:",
                error.what());
    }
  }
  return designs;
}

/// Reads `data`. `sizes` has the steps of the frequency that has most.
ArrayFiles read_data(const YamlSection& section, const CorrelationDescription& description,
                     const ArraySizes& sizes) {
  section.allow_only({"files", "axes", "images", "type", "byte_order", "byte_offset", "member",
                      "frequency_names", "step_names", "frames", "first_frame", "reshape"});
  ArrayFiles files = read_array_files(section, sizes);
  std::size_t images = 0;
  bool steps_differ = false;
  for (const StepDesign& design : description.designs) {
    images += static_cast<std::size_t>(design.steps());
    steps_differ |= design.steps() != sizes.steps;
  }
  const std::size_t unused = std::ranges::count(files.images, StepPlace{-1, -1});
  if (!files.images.empty() && files.images.size() - unused != images) {
    section.fail(section.key("images"), "names " + std::to_string(files.images.size() - unused) +
                                            " images, but there are " + std::to_string(images) +
                                            " step angles");
  }
  const auto is_axis = [&](ArrayAxis axis) { return std::ranges::count(files.axes, axis) > 0; };
  if (steps_differ && is_axis(ArrayAxis::step) && is_axis(ArrayAxis::frequency)) {
    section.fail(section.key("axes"),
                 "has 'frequency' and 'step', but frequencies differ in their number of steps; use "
                 "the axis 'image' and list the images");
  }
  for (std::size_t i = 0; i < files.images.size(); ++i) {
    const StepPlace place = files.images[i];
    if (place.frequency < 0) continue;
    const int steps = description.designs[static_cast<std::size_t>(place.frequency)].steps();
    if (place.step < steps) continue;
    section.fail(section.key("images"), "has step " + std::to_string(place.step) +
                                            " of frequency " + std::to_string(place.frequency) +
                                            ", which has " + std::to_string(steps));
  }
  return files;
}

void read_amplitude(const YamlSection& section, CorrelationDescription& description) {
  section.allow_only({"min", "max"});
  if (section.has("min")) description.min_amplitude = section.value<double>("min", "a number");
  if (section.has("max")) description.max_amplitude = section.value<double>("max", "a number");
  if (description.min_amplitude < 0) section.fail(section.key("min"), "must be 0 or more");
  if (section.has("max") && !(description.max_amplitude > description.min_amplitude)) {
    section.fail(section.key("max"), "must be above 'min', and above 0");
  }
}

/// The sizes that arrays of frames have if no frequency has fewer steps than another.
ArraySizes largest_sizes(const CorrelationDescription& description) {
  ArraySizes sizes;
  sizes.frequencies = static_cast<std::int64_t>(description.frequencies_hz.size());
  for (const StepDesign& design : description.designs) {
    sizes.steps = std::max<std::int64_t>(sizes.steps, design.steps());
  }
  sizes.rows = description.camera.height_px;
  sizes.columns = description.camera.width_px;
  return sizes;
}

void read_exposure(const YamlSection& root, CorrelationDescription& description) {
  const std::size_t frequencies = description.frequencies_hz.size();
  description.exposure_offsets_s.assign(frequencies, 0);
  if (root.has("exposure_offsets_s")) {
    description.exposure_offsets_s = root.value<std::vector<double>>(
        "exposure_offsets_s", "a list of seconds after the timestamp, one per frequency");
    check_count(root, "exposure_offsets_s", description.exposure_offsets_s.size(), frequencies,
                "frequencies");
  }
  for (const double offset_s : description.exposure_offsets_s) {
    if (offset_s < 0) root.fail("exposure_offsets_s", "must be 0 or more, after the timestamp");
  }
  if (!root.has("max_range_m")) return;
  description.max_range_m = root.value<double>("max_range_m", "a number of metres");
  if (!(description.max_range_m > 0)) {
    root.fail("max_range_m", "must be above 0; leave it out if it is not known");
  }
  Modulation modulation;
  modulation.frequencies_hz = description.frequencies_hz;
  const std::string fault = range_limit_fault(description.max_range_m, modulation);
  if (!fault.empty()) root.fail("max_range_m", fault);
}

}  // namespace

CorrelationDescription read_correlation_description(const std::filesystem::path& file) {
  const YamlSection root = load_yaml(
      file, "it must be a description of correlation images (docs/import-correlation.md)");
  check_format(root, description_format, description_version);
  root.allow_only({"format", "version", "camera", "max_range_m", "frequencies_hz",
                   "exposure_offsets_s", "step_angles_deg", "step_angles_rad", "phase_sign",
                   "steps", "offset", "data", "values", "dark", "phase_offsets", "timestamps",
                   "amplitude"});
  CorrelationDescription description;
  description.file = file;
  description.camera = read_camera(root.section("camera"));
  naming(file.string(), [&] { validate(description.camera); });
  description.frequencies_hz = read_frequencies(root);
  read_exposure(root, description);
  description.designs = read_designs(root, description.frequencies_hz.size());
  description.differential =
      word_of<bool>(root, "steps", {{"differential", true}, {"single_ended", false}});
  if (!description.differential && !description.designs.front().with_offset()) {
    root.fail("offset", "must be 'fitted' if steps are single_ended, which contain ambient light");
  }
  const ArraySizes sizes = largest_sizes(description);
  description.data = read_data(root.section("data"), description, sizes);
  if (root.has("values")) description.values = read_step_values(root.section("values"));
  if (root.has("dark")) description.dark = read_dark(root.section("dark"), sizes);
  description.phase_offsets.cycles.assign(description.frequencies_hz.size(), 0);
  if (root.has("phase_offsets")) {
    description.phase_offsets =
        read_phase_offsets(root.section("phase_offsets"), sizes, description.frequencies_hz);
  }
  if (root.has("timestamps")) {
    description.times = read_frame_times(root.section("timestamps"), file.parent_path());
  }
  if (root.has("amplitude")) read_amplitude(root.section("amplitude"), description);
  return description;
}

}  // namespace tofmap

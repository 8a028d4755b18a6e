// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "description_section.hpp"
#include "file_pattern.hpp"

#include <algorithm>

namespace tofmap {
namespace {

const std::vector<std::pair<std::string, ArrayAxis>> axis_words = {
    {"frame", ArrayAxis::frame}, {"frequency", ArrayAxis::frequency},
    {"step", ArrayAxis::step},   {"image", ArrayAxis::image},
    {"row", ArrayAxis::row},     {"column", ArrayAxis::column}};

/// Eight frequencies of 64 steps each, and as many images that are not used.
constexpr std::size_t most_images = 1024;

constexpr const char* axes_expected =
    "a list of axes, of frame, frequency, step, image, row and column, the one that varies fastest "
    "at the end";

std::vector<ArrayAxis> read_axes(const YamlSection& section) {
  std::vector<ArrayAxis> axes;
  for (const auto& word : section.value<std::vector<std::string>>("axes", axes_expected)) {
    const auto found =
        std::ranges::find(axis_words, word, &std::pair<std::string, ArrayAxis>::first);
    if (found == axis_words.end()) {
      section.fail(section.key("axes"),
                   "has the unknown axis '" + word + "'; it must be " + axes_expected);
    }
    if (std::ranges::count(axes, found->second) > 0) {
      section.fail(section.key("axes"), "has the axis '" + word + "' twice");
    }
    axes.push_back(found->second);
  }
  return axes;
}

/// Reads `images`: a list of [frequency, step], or [] for an image that is not used.
std::vector<StepPlace> read_images(const YamlSection& section, const ArraySizes& sizes) {
  constexpr const char* expected =
      "a list of [frequency, step], counted from 0, with [] for images that are not used";
  const std::string key = section.key("images");
  std::vector<StepPlace> places;
  for (const auto& pair : section.value<std::vector<std::vector<int>>>("images", expected)) {
    if (pair.empty()) {
      places.push_back({-1, -1});
      continue;
    }
    if (pair.size() != 2) section.fail(key, std::string("must be ") + expected);
    const StepPlace place{pair[0], pair[1]};
    const std::string text =
        "[" + std::to_string(place.frequency) + ", " + std::to_string(place.step) + "]";
    const bool exists = place.frequency >= 0 && place.frequency < sizes.frequencies &&
                        place.step >= 0 && place.step < sizes.steps;
    if (!exists) {
      section.fail(key, "has " + text + ", but the description has " +
                            std::to_string(sizes.frequencies) + " frequencies and at most " +
                            std::to_string(sizes.steps) + " steps, counted from 0");
    }
    if (std::ranges::count(places, place) > 0) section.fail(key, "has " + text + " twice");
    places.push_back(place);
  }
  if (places.size() > most_images) {
    section.fail(key, "has more than " + std::to_string(most_images) + " images");
  }
  return places;
}

std::vector<std::string> read_names(const YamlSection& section, const std::string& name,
                                    std::int64_t count) {
  if (!section.has(name)) return {};
  auto names = section.value<std::vector<std::string>>(name, "a list of names");
  check_count(section, name, names.size(), static_cast<std::size_t>(count),
              name == "frequency_names" ? "frequencies" : "steps");
  for (const std::string& one : names) {
    if (one.empty() || one.find('/') != std::string::npos) {
      section.fail(section.key(name),
                   "has the name '" + one + "'; names must not be empty or have /");
    }
  }
  return names;
}

ArrayFileOptions read_file_options(const YamlSection& section) {
  ArrayFileOptions options;
  if (section.has("member")) options.member = section.value<std::string>("member", "a name");
  if (section.has("type")) {
    const auto name = section.value<std::string>("type", element_type_names);
    options.raw_type = element_type_named(name);
    if (!options.raw_type) {
      section.fail(section.key("type"),
                   std::string("must be ") + element_type_names + ", not '" + name + "'");
    }
  }
  if (section.has("byte_order")) {
    const bool is_big = word_of<bool>(section, "byte_order", {{"little", false}, {"big", true}});
    if (!options.raw_type) {
      section.fail(section.key("byte_order"), "is for raw binary files, which need 'type' as well");
    }
    options.raw_type->big_endian = is_big;
  }
  if (section.has("byte_offset")) {
    options.raw_offset_bytes = section.value<std::int64_t>("byte_offset", "a number of bytes");
    if (options.raw_offset_bytes < 0) {
      section.fail(section.key("byte_offset"),
                   "must be 0 or more, not " + std::to_string(options.raw_offset_bytes));
    }
  }
  return options;
}

/// Checks that every index of an image is known from an axis or a field, and only once.
void check_axes(const YamlSection& section, const ArrayFiles& files, const FilePattern& pattern,
                const ArraySizes& sizes) {
  const auto in_axes = [&](ArrayAxis axis) { return std::ranges::count(files.axes, axis) > 0; };
  const auto is_given = [&](ArrayAxis axis) { return in_axes(axis) || pattern.has(axis); };
  for (const auto& [word, axis] : axis_words) {
    if (in_axes(axis) && pattern.has(axis)) {
      std::string problem = "has the axis '";
      problem.append(word).append("', and 'files' has {").append(word);
      section.fail(section.key("axes"), problem + "}; only one of them may have it");
    }
  }
  const auto demand = [&](ArrayAxis axis, std::int64_t size, bool has_it) {
    if (size == 1 || has_it) return;
    section.fail(section.key("axes"),
                 std::string("must have '") + name_of(axis) + "', of size " + std::to_string(size));
  };
  const bool has_image = is_given(ArrayAxis::image);
  demand(ArrayAxis::row, sizes.rows, in_axes(ArrayAxis::row));
  demand(ArrayAxis::column, sizes.columns, in_axes(ArrayAxis::column));
  demand(ArrayAxis::frequency, sizes.frequencies, has_image || is_given(ArrayAxis::frequency));
  demand(ArrayAxis::step, sizes.steps, has_image || is_given(ArrayAxis::step));
  if (has_image && (is_given(ArrayAxis::frequency) || is_given(ArrayAxis::step))) {
    section.fail(section.key("axes"),
                 "has 'image', which stands for frequency and step; they cannot be given as well");
  }
  if (has_image != !files.images.empty()) {
    section.fail(section.key("images"),
                 has_image ? "is missing; it says which frequency and step each image is"
                           : "is given, but neither axes nor files have 'image'");
  }
}

}  // namespace

void check_count(const YamlSection& section, const std::string& name, std::size_t given,
                 std::size_t wanted, const std::string& of_what) {
  if (given == wanted) return;
  section.fail(section.key(name), "has " + std::to_string(given) + " entries, but there are " +
                                      std::to_string(wanted) + " " + of_what);
}

ArrayFiles read_array_files(const YamlSection& section, const ArraySizes& sizes) {
  ArrayFiles files;
  files.pattern = section.value<std::string>("files", "the name of a file, or a pattern of names");
  if (files.pattern.empty()) section.fail(section.key("files"), "is empty");
  files.options = read_file_options(section);
  files.axes = read_axes(section);
  if (section.has("images")) files.images = read_images(section, sizes);
  files.frequency_names = read_names(section, "frequency_names", sizes.frequencies);
  files.step_names = read_names(section, "step_names", sizes.steps);
  if (section.has("frames")) {
    files.frames = section.value<int>("frames", "a number of frames");
    if (files.frames < 1 || files.frames > most_frames) {
      section.fail(section.key("frames"), "must be 1 to " + std::to_string(most_frames));
    }
  }
  if (section.has("first_frame")) {
    files.first_frame = section.value<int>("first_frame", "the number of the first frame");
    if (files.first_frame < 0) section.fail(section.key("first_frame"), "must be 0 or more");
    if (files.frames == 0) section.fail(section.key("first_frame"), "needs 'frames' as well");
  }
  if (section.has("reshape")) files.reshape = section.value<bool>("reshape", "true or false");
  try {
    check_axes(section, files, FilePattern(files.pattern, files.frequency_names, files.step_names),
               sizes);
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (!message.starts_with("'")) throw;
    section.fail(section.key("files"), message);
  }
  return files;
}

}  // namespace tofmap

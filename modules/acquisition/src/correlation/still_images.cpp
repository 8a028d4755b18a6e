// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "still_images.hpp"

#include "image_files.hpp"

#include <algorithm>
#include <numbers>
#include <string>

#include <tofmap/core/error.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {
namespace {

bool has_axis(const ArrayFiles& files, const std::string& name) {
  const auto is_named = [&](ArrayAxis axis) { return name_of(axis) == name; };
  return std::ranges::any_of(files.axes, is_named) ||
         files.pattern.find("{" + name) != std::string::npos;
}

/// Images that are given once for all frames, by frequency and step. An image that is not given for
/// each frequency or step is repeated.
std::vector<std::vector<ImageF>> still_images(const CorrelationDescription& description,
                                              const ArrayFiles& files,
                                              const std::vector<int>& steps) {
  const bool has_images = has_axis(files, "image");
  const bool of_each_step = has_images || has_axis(files, "step");
  const bool of_each_frequency = has_images || has_axis(files, "frequency");
  if (of_each_step && !of_each_frequency &&
      std::ranges::any_of(steps, [&](int count) { return count != steps.front(); })) {
    throw InputError(description.file.string() + ": " + files.pattern +
                     " has an image for each step, but frequencies differ in their number of "
                     "steps; its axes must have 'frequency' or 'image' as well");
  }
  std::vector<int> given = of_each_step ? steps : std::vector<int>(steps.size(), 1);
  if (!of_each_frequency) given.resize(1);
  ImageFiles reader(files, description.file.parent_path(), given, description.camera, {}, 1);
  const std::vector<std::vector<StepImage>> read = reader.read(0);
  std::vector<std::vector<ImageF>> images(steps.size());
  for (std::size_t f = 0; f < steps.size(); ++f) {
    const std::vector<StepImage>& of_frequency = read[of_each_frequency ? f : 0];
    for (std::size_t k = 0; k < static_cast<std::size_t>(steps[f]); ++k) {
      images[f].push_back(of_frequency[of_each_step ? k : 0].values);
    }
  }
  return images;
}

/// How many cycles of a frequency the unit is.
double cycles_in(PhaseUnit unit, double frequency_hz) {
  switch (unit) {
    case PhaseUnit::cycles:
      return 1;
    case PhaseUnit::radians:
      return 0.5 / std::numbers::pi;
    case PhaseUnit::metres:
      return 2 * frequency_hz / speed_of_light_m_per_s;
  }
  return 1;
}

}  // namespace

std::vector<std::vector<ImageF>> dark_images(const CorrelationDescription& description) {
  if (!description.dark.files) return {};
  return still_images(description, *description.dark.files, description.step_counts());
}

std::vector<ImageF> phase_offset_images(const CorrelationDescription& description) {
  const PhaseOffsets& offsets = description.phase_offsets;
  if (!offsets.files) return {};
  const std::vector<int> one_each(description.frequencies_hz.size(), 1);
  std::vector<ImageF> images;
  for (const auto& of_frequency : still_images(description, *offsets.files, one_each)) {
    const double cycles = cycles_in(offsets.file_unit, description.frequencies_hz[images.size()]);
    images.push_back(of_frequency.front() * static_cast<float>(cycles));
  }
  return images;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/correlation/correlation_reader.hpp"

#include "frame_times.hpp"
#include "image_files.hpp"
#include "still_images.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

/// The variance of rounding to whole numbers.
constexpr double rounding_variance = 1.0 / 12;

/// Subtracts the offsets from phases, which stay in [0, 1). `image` may be empty.
void subtract_offsets(ImageF& phase, double offset_cycles, const ImageF& image) {
  for (Eigen::Index i = 0; i < phase.size(); ++i) {
    const double off = offset_cycles + (image.size() > 0 ? double{image.data()[i]} : 0);
    const double cycles = double{phase.data()[i]} - off;
    const auto wrapped = static_cast<float>(cycles - std::floor(cycles));
    phase.data()[i] = wrapped >= 1 ? 0 : wrapped;  // rounding may give a whole cycle
  }
}

/// The variance of rounding of the values: of numbers in a file, or of single precision.
double least_variance(const std::vector<StepImage>& steps) {
  if (steps.front().whole_numbers) return rounding_variance;
  double largest = 0;
  for (const StepImage& step : steps) {
    for (const float value : step.values.reshaped()) {
      if (std::isfinite(value)) largest = std::max(largest, std::abs(double{value}));
    }
  }
  const double rounding = largest * std::numeric_limits<float>::epsilon();
  return rounding * rounding;
}

FrequencyMeasurement measurement(const std::vector<StepImage>& steps, const StepDesign& design,
                                 const CorrelationDescription& description) {
  FrequencyMeasurement result;
  std::vector<ImageF> values;
  result.saturated = ImageU8::Zero(steps.front().values.rows(), steps.front().values.cols());
  for (const StepImage& step : steps) {
    values.push_back(step.values);
    result.saturated = result.saturated.max(step.saturated);
  }
  const StepFit fit = fit_steps(values, design);
  const auto least = static_cast<float>(description.min_amplitude);
  const auto most = static_cast<float>(description.max_amplitude);
  result.amplitude = fit.amplitude;
  result.phase = (fit.amplitude >= least).select(fit.phase, nan);
  if (most > 0) {
    result.saturated = result.saturated.max((fit.amplitude > most).cast<std::uint8_t>());
  }
  result.inconsistent = ImageU8::Zero(fit.amplitude.rows(), fit.amplitude.cols());
  const int freedom = design.degrees_of_freedom();
  if (freedom == 0) return result;
  result.residual = (fit.squared_residual / static_cast<float>(freedom)).sqrt();
  const ImageF& signal = description.differential ? fit.amplitude : fit.offset;
  result.noise = estimate_step_noise(signal, fit.squared_residual, result.saturated, freedom,
                                     least_variance(steps));
  result.inconsistent = inconsistent_pixels(signal, fit.squared_residual, result.noise, freedom);
  return result;
}

/// Throws InputError if more than half of the frames are missing.
void refuse_mostly_missing(const ImageFiles& images) {
  int missing = 0;
  std::string first_reason;
  for (int i = 0; i < images.frame_count(); ++i) {
    const std::string reason = images.damage(i);
    if (reason.empty()) continue;
    if (++missing == 1) first_reason = reason;
  }
  if (2 * missing <= images.frame_count()) return;
  throw InputError(first_reason + " (" + std::to_string(missing) + " of " +
                   counted(static_cast<std::size_t>(images.frame_count()), "frame") +
                   " cannot be read)");
}

}  // namespace

struct CorrelationReader::Files {
  ImageFiles images;
};

CorrelationReader::CorrelationReader(CorrelationDescription description)
    : description_(std::move(description)) {
  timestamps_s_ = listed_times_s(description_.times, description_.file);
  const auto listed = static_cast<std::int64_t>(timestamps_s_.size());
  files_ = std::make_unique<Files>(Files{
      ImageFiles(description_.data, description_.file.parent_path(), description_.step_counts(),
                 description_.camera, description_.values, listed)});
  const ImageFiles& images = files_->images;
  const int frames = images.frame_count();
  if (listed > 0 && listed != frames) {
    throw InputError(description_.file.string() + ": timestamps has " + std::to_string(listed) +
                     " entries, but there are " +
                     counted(static_cast<std::size_t>(frames), "frame"));
  }
  for (int i = 0; listed == 0 && i < frames; ++i) {
    timestamps_s_.push_back(
        regular_time_s(description_.times, images.number(i) - images.number(0)));
  }
  refuse_mostly_missing(images);
  dark_ = dark_images(description_);
  phase_offsets_cycles_ = phase_offset_images(description_);
}

CorrelationReader::CorrelationReader(CorrelationReader&&) noexcept = default;
CorrelationReader& CorrelationReader::operator=(CorrelationReader&&) noexcept = default;
CorrelationReader::~CorrelationReader() = default;

std::vector<FrequencyMeasurement> CorrelationReader::measure(int index) {
  std::vector<std::vector<StepImage>> images = files_->images.read(index);
  std::vector<FrequencyMeasurement> measurements;
  for (std::size_t f = 0; f < images.size(); ++f) {
    for (std::size_t k = 0; k < images[f].size(); ++k) {
      images[f][k].values -= static_cast<float>(description_.dark.value);
      if (!dark_.empty()) images[f][k].values -= dark_[f][k];
    }
    measurements.push_back(measurement(images[f], description_.designs[f], description_));
    subtract_offsets(measurements.back().phase, description_.phase_offsets.cycles[f],
                     phase_offsets_cycles_.empty() ? ImageF() : phase_offsets_cycles_[f]);
  }
  return measurements;
}

CorrelationFrame CorrelationReader::read(int index) {
  if (index < 0 || index >= frame_count()) {
    throw UsageError("frame " + std::to_string(index) + " of " + description_.file.string() +
                     ": the frames are 0 to " + std::to_string(frame_count() - 1));
  }
  CorrelationFrame frame;
  frame.index = index;
  frame.timestamp_s = timestamps_s_[static_cast<std::size_t>(index)];
  frame.damage = files_->images.damage(index);
  if (!frame.damage.empty()) return frame;
  try {
    frame.frequencies = measure(index);
  } catch (const InputError& error) {
    frame.damage = error.what();
  }
  return frame;
}

}  // namespace tofmap

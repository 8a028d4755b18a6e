// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/correlation/correlation_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// The largest amplitude of a pixel that is not saturated.
constexpr float largest_amplitude = saturated_correlation_amplitude - 1;

SensorModel sensor_of(const CorrelationDescription& description) {
  SensorModel sensor;
  sensor.camera = description.camera;
  sensor.modulation.frequencies_hz = description.frequencies_hz;
  const std::vector<double>& offsets_s = description.exposure_offsets_s;
  const bool is_spread = std::ranges::any_of(offsets_s, [](double s) { return s != 0; });
  if (is_spread) sensor.modulation.exposure_offsets_s = offsets_s;
  sensor.max_range_m = description.max_range_m;
  sensor.saturation_amplitude = saturated_correlation_amplitude;
  return sensor;
}

/// The largest magnitude of a value that is not saturated, as the description has it. 0: unknown.
double largest_value(const StepValues& values) {
  if (std::isfinite(values.saturated_from) && values.saturated_from > 0) {
    return values.saturated_from;
  }
  if (!values.companding.empty()) {
    double largest = 0;
    for (const float value : values.companding)
      largest = std::max(largest, std::abs(double{value}));
    return largest;
  }
  return values.bits > 0 ? std::exp2(values.bits) : 0;
}

/// The largest amplitude that pixels without saturation have, as the description has it. 0:
/// unknown.
double largest_amplitude_of(const CorrelationDescription& description) {
  if (description.max_amplitude > 0) return description.max_amplitude;
  // Four steps of ±1 have an amplitude of up to √2, and no other number of even ones more.
  return std::numbers::sqrt2 * largest_value(description.values);
}

/// The same of the first frame that is whole, with room for brighter frames. 0 if no frame has
/// light.
double largest_amplitude_seen(CorrelationReader& reader) {
  constexpr double room = 4;
  for (int i = 0; i < reader.frame_count(); ++i) {
    double largest = 0;
    for (const FrequencyMeasurement& measured : reader.read(i).frequencies) {
      for (Eigen::Index p = 0; p < measured.amplitude.size(); ++p) {
        const double amplitude = measured.amplitude.data()[p];
        if (measured.saturated.data()[p] == 0 && std::isfinite(amplitude)) {
          largest = std::max(largest, amplitude);
        }
      }
    }
    if (largest > 0) return room * largest;
  }
  return 0;
}

double scale_for(double amplitude) {
  return amplitude > 0 ? std::exp2(std::floor(std::log2(largest_amplitude / amplitude))) : 1;
}

/// Phase and amplitude of one frequency, as CorrelationSource describes them.
struct ScaledImages {
  ImageF phase;
  ImageF amplitude;
};

ScaledImages scaled(const FrequencyMeasurement& measured, double scale, bool keep_inconsistent) {
  ScaledImages images{measured.phase, measured.amplitude};
  for (Eigen::Index i = 0; i < images.phase.size(); ++i) {
    float& phase = images.phase.data()[i];
    float& amplitude = images.amplitude.data()[i];
    if (measured.saturated.data()[i] != 0) {
      amplitude = saturated_correlation_amplitude;
      if (std::isnan(phase)) phase = 0;  // else the pixel would have no return
      continue;
    }
    // Values that are not finite have neither.
    amplitude = std::isfinite(amplitude)
                    ? static_cast<float>(std::min(amplitude * scale, double{largest_amplitude}))
                    : 0.0F;
    if (measured.inconsistent.data()[i] != 0 && !keep_inconsistent) phase = nan;
  }
  return images;
}

/// The residual relative to amplitude and residual together, in the median pixel of the quarter in
/// which these are largest. Saturated pixels are left out. NaN if residuals are not known, or
/// without light.
double relative_residual(const FrequencyMeasurement& measured) {
  struct Pixel {
    float signal;
    float residual;
  };
  std::vector<Pixel> pixels;
  for (Eigen::Index i = 0; i < measured.residual.size(); ++i) {
    const float residual = measured.residual.data()[i];
    const float signal = std::hypot(measured.amplitude.data()[i], residual);
    if (measured.saturated.data()[i] == 0 && signal > 0) pixels.push_back({signal, residual});
  }
  if (pixels.empty()) return nan;
  const auto bright = pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixels.size() / 4);
  std::ranges::nth_element(pixels, bright, {}, &Pixel::signal);
  std::vector<double> shares;
  for (auto pixel = bright; pixel != pixels.end(); ++pixel) {
    shares.push_back(double{pixel->residual} / double{pixel->signal});
  }
  return median(shares);
}

std::int64_t count_inconsistent(const std::vector<FrequencyMeasurement>& frequencies) {
  ImageU8 inconsistent = frequencies.front().inconsistent;
  ImageU8 saturated = frequencies.front().saturated;
  for (const FrequencyMeasurement& measured : frequencies) {
    inconsistent = inconsistent.max(measured.inconsistent);
    saturated = saturated.max(measured.saturated);
  }
  return (inconsistent != 0 && saturated == 0).count();
}

}  // namespace

CorrelationSource::CorrelationSource(CorrelationReader reader, bool keep_inconsistent)
    : reader_(std::move(reader)),
      sensor_(sensor_of(reader_.description())),
      keep_inconsistent_(keep_inconsistent) {
  double largest = largest_amplitude_of(reader_.description());
  if (!(largest > 0)) largest = largest_amplitude_seen(reader_);
  amplitude_scale_ = scale_for(largest);
}

Frame CorrelationSource::frame_of(const CorrelationFrame& read) {
  Frame frame;
  frame.index = read.index;
  frame.timestamp_s = read.timestamp_s;
  relative_residuals_.resize(read.frequencies.size());
  for (std::size_t f = 0; f < read.frequencies.size(); ++f) {
    const FrequencyMeasurement& measured = read.frequencies[f];
    const double residual = relative_residual(measured);
    if (std::isfinite(residual)) relative_residuals_[f].push_back(residual);
    ScaledImages images = scaled(measured, amplitude_scale_, keep_inconsistent_);
    frame.phases.push_back(std::move(images.phase));
    frame.amplitudes.push_back(std::move(images.amplitude));
  }
  inconsistent_pixels_ += count_inconsistent(read.frequencies);
  return frame;
}

std::vector<double> CorrelationSource::relative_residuals() const {
  std::vector<double> medians;
  for (std::vector<double> of_frames : relative_residuals_) {
    medians.push_back(of_frames.empty() ? nan : median(of_frames));
  }
  return medians;
}

std::optional<SourcedFrame> CorrelationSource::next() {
  if (next_ >= reader_.frame_count()) return std::nullopt;
  const CorrelationFrame read = reader_.read(next_++);
  SourcedFrame sourced{
      .index = read.index, .timestamp_s = read.timestamp_s, .frame = {}, .damage = read.damage};
  if (read.damage.empty()) sourced.frame = frame_of(read);
  return sourced;
}

}  // namespace tofmap

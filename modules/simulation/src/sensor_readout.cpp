// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sensor_readout.hpp"

#include "noise.hpp"
#include "sensor_effects.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/ideal_frame.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

void read_image(const ImageC& ideal, const SensorReadout& readout, ImageF& phase,
                ImageF& amplitude) {
  phase = ImageF::Constant(ideal.rows(), ideal.cols(), nan);
  amplitude = ImageF::Zero(ideal.rows(), ideal.cols());
  for (Eigen::Index v = 0; v < ideal.rows(); ++v) {
    for (Eigen::Index u = 0; u < ideal.cols(); ++u) {
      if (std::isnan(ideal(v, u).real())) continue;
      const auto pixel = readout.read(ideal(v, u), v, u);
      if (!pixel) continue;
      phase(v, u) = pixel->measured.phase_cycles;
      amplitude(v, u) = pixel->measured.amplitude;
    }
  }
}

void check_size(const ImageC& signal, const CameraModel& camera) {
  if (signal.rows() == camera.height_px && signal.cols() == camera.width_px) return;
  throw UsageError("ideal frame has " + std::to_string(signal.cols()) + " x " +
                   std::to_string(signal.rows()) + " pixels, but the camera has " +
                   std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px));
}

}  // namespace

std::uint64_t noise_key(const SimulatorOptions& options, int frame, std::size_t frequency,
                        std::size_t frequencies) {
  return mix(mix(static_cast<std::uint64_t>(options.seed)) +
             frequencies * static_cast<unsigned>(frame) + frequency);
}

std::optional<SensorReadout::Pixel> SensorReadout::read(const std::complex<double>& ideal_,
                                                        Eigen::Index row, Eigen::Index col) const {
  const std::complex<double> ideal = contrast * ideal_;
  const auto pixel = static_cast<std::size_t>(row * cols + col);
  const double sigma = ambient.noise_factor(row, col) * noise_sigma;
  const std::complex<double> rotation = errors.rotation(ideal, pixel);
  const std::complex<double> signal = rotation * ideal + sigma * complex_noise(noise_key, pixel);
  auto measured = measure(signal);
  if (!measured) return std::nullopt;
  measured->phase_cycles = quantised(measured->phase_cycles, phase_bits);
  return Pixel{*measured, std::conj(rotation) * signal,
               sigma / std::abs(signal) * wavelength_m / (2 * std::numbers::pi)};
}

SensorReadout sensor_readout(const SimulatorOptions& options, const SensorModel& sensor, int frame,
                             std::size_t frequency) {
  const Modulation& modulation = sensor.modulation;
  const double dark_sigma = dark_noise_sigma(sensor_effects(options, modulation));
  return {.wavelength_m = modulation.wavelength_m(frequency),
          .contrast = frequency < options.contrasts.size() ? options.contrasts[frequency] : 1,
          .errors = range_errors(options, modulation, frequency),
          .ambient = ambient_light(options, sensor.camera),
          .noise_sigma = std::hypot(noise_strength(options.range_noise_m, modulation), dark_sigma),
          .noise_key = noise_key(options, frame, frequency, modulation.count()),
          .phase_bits = options.phase_bits,
          .cols = sensor.camera.width_px};
}

Frame measured_frame(const IdealFrame& ideal, const SensorModel& sensor,
                     const SimulatorOptions& options) {
  check_systematic_errors(options);
  Frame frame = blank_frame(ideal.signals.size());
  frame.index = ideal.index;
  frame.timestamp_s = ideal.timestamp_s;
  for (std::size_t f = 0; f < ideal.signals.size(); ++f) {
    check_size(ideal.signals[f], sensor.camera);
    read_image(ideal.signals[f], sensor_readout(options, sensor, ideal.index, f), frame.phases[f],
               frame.amplitudes[f]);
  }
  return frame;
}

}  // namespace tofmap

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

std::uint64_t noise_key(const SimulatorOptions& options, int frame, ImageOfFrame image) {
  return mix(mix(static_cast<std::uint64_t>(options.seed)) + 2 * static_cast<unsigned>(frame) +
             static_cast<unsigned>(image));
}

std::optional<SensorReadout::Pixel> SensorReadout::read(const std::complex<double>& ideal,
                                                        Eigen::Index row, Eigen::Index col) const {
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
                             ImageOfFrame image) {
  const Modulation& modulation = sensor.modulation;
  const double dark_sigma = dark_noise_sigma(sensor_effects(options, modulation));
  const bool is_a = image == ImageOfFrame::a;
  return {
      .wavelength_m = is_a ? modulation.wavelength_a_m() : modulation.wavelength_b_m(),
      .errors = is_a ? range_errors_a(options, modulation) : range_errors_b(options, modulation),
      .ambient = ambient_light(options, sensor.camera),
      .noise_sigma = std::hypot(noise_strength(options.range_noise_m, modulation), dark_sigma),
      .noise_key = noise_key(options, frame, image),
      .phase_bits = options.phase_bits,
      .cols = sensor.camera.width_px};
}

DualFrequencyFrame measured_frame(const IdealFrame& ideal, const SensorModel& sensor,
                                  const SimulatorOptions& options) {
  check_size(ideal.signal_a, sensor.camera);
  check_size(ideal.signal_b, sensor.camera);
  check_systematic_errors(options);
  DualFrequencyFrame frame;
  frame.index = ideal.index;
  frame.timestamp_s = ideal.timestamp_s;
  read_image(ideal.signal_a, sensor_readout(options, sensor, ideal.index, ImageOfFrame::a),
             frame.phase_a, frame.amplitude_a);
  read_image(ideal.signal_b, sensor_readout(options, sensor, ideal.index, ImageOfFrame::b),
             frame.phase_b, frame.amplitude_b);
  return frame;
}

}  // namespace tofmap

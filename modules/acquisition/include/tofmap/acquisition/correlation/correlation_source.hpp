// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <tofmap/acquisition/correlation/correlation_reader.hpp>
#include <tofmap/acquisition/frame_source.hpp>

namespace tofmap {

/// The amplitude of a saturated pixel in a frame of correlation images. It is larger than all
/// others.
inline constexpr float saturated_correlation_amplitude = 65535;

/// The frames of arrays of correlation images.
///
/// A pixel that is inconsistent at a frequency (FrequencyMeasurement) has no phase (NaN) there,
/// unless it is saturated as well. A saturated pixel has the sensor's `saturation_amplitude`, which
/// is `saturated_correlation_amplitude`, and a phase, which is not used.
///
/// Amplitudes are multiplied by amplitude_scale(), so that they fit into the 16 bits of a sequence.
/// It is a power of 2 and the same for all frames of a recording. If the description limits the
/// values, by `values.bits`, companding, `values.saturation.from` or `amplitude.max`, it depends
/// on the description alone: the largest amplitude of evenly spaced steps of such values just
/// fits. Otherwise, four times the largest amplitude of the first whole frame fits. Amplitudes
/// beyond the scale become 65534: they are not saturated.
class CorrelationSource final : public FrameSource {
 public:
  /// Reads the first whole frame if the scale of amplitudes depends on it. If `keep_inconsistent`,
  /// inconsistent pixels keep their phases.
  explicit CorrelationSource(CorrelationReader reader, bool keep_inconsistent = false);

  const SensorModel& sensor() const override { return sensor_; }
  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override { return reader_.frame_count(); }

  double amplitude_scale() const { return amplitude_scale_; }

  /// Number of pixels of all frames so far that are inconsistent at one of the frequencies, and
  /// saturated at none.
  std::int64_t inconsistent_pixels() const { return inconsistent_pixels_; }

  /// For each frequency, the median over the frames so far of how large
  /// FrequencyMeasurement::residual is relative to amplitude and residual together (√(a² + r²)), in
  /// the median pixel of the quarter in which these are largest. A description that is not that of
  /// the data makes it large in all pixels. NaN where it is not known.
  std::vector<double> relative_residuals() const;

 private:
  Frame frame_of(const CorrelationFrame& read);

  CorrelationReader reader_;
  SensorModel sensor_;
  double amplitude_scale_ = 1;
  bool keep_inconsistent_ = false;
  std::int64_t inconsistent_pixels_ = 0;
  std::vector<std::vector<double>> relative_residuals_;  ///< of each frequency, of each frame
  int next_ = 0;
};

}  // namespace tofmap

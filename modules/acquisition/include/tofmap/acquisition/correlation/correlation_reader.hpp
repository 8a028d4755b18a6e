// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tofmap/acquisition/correlation/correlation_description.hpp>
#include <tofmap/acquisition/correlation/step_noise.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// What the correlation images of one frequency tell. All images have the size of the camera.
struct FrequencyMeasurement {
  /// Phase in cycles, [0, 1), without the phase offsets. NaN where there is no signal: the
  /// amplitude is 0 or below the least allowed one, or a value is not finite.
  ImageF phase;
  ImageF amplitude;  ///< in units of the values; NaN where a value is not finite
  /// Standard deviation of the values around the fit, √(Σ residual² / (steps − unknowns)), in units
  /// of the values. Empty if there are no more steps than unknowns.
  ImageF residual;
  /// 1 where a step is saturated or the amplitude is above the largest allowed one, so that phase
  /// and amplitude, which are kept, are wrong; else 0.
  ImageU8 saturated;
  /// 1 where the residual is larger than the noise explains (inconsistent_pixels()): something
  /// moved between the steps or one was saturated; else 0. All 0 if residuals are empty.
  ImageU8 inconsistent;
  StepNoise noise;  ///< of this image, from its residuals
};

/// A frame, or the reason why it cannot be used.
struct CorrelationFrame {
  int index = 0;
  double timestamp_s = 0;
  std::string damage;  ///< names the file and what is wrong; empty if the frame is whole
  std::vector<FrequencyMeasurement> frequencies;  ///< empty if the frame is damaged
};

/// Reads arrays of correlation images frame by frame, in any order, and fits phase and amplitude.
/// Images of one frame only are in memory. One object must not be used by two threads at once.
///
/// A fault of the whole recording throws InputError when it is opened. A fault of one frame damages
/// that frame only: a file that is missing, truncated or damaged, or that has another size or type.
class CorrelationReader {
 public:
  /// Opens the files of a description. Throws InputError, which names the file, the key and the
  /// remedy, if files contradict the description, if the number of timestamps is not that of
  /// frames, or if there are no frames or more than half of them are missing.
  explicit CorrelationReader(CorrelationDescription description);
  CorrelationReader(CorrelationReader&&) noexcept;
  CorrelationReader& operator=(CorrelationReader&&) noexcept;
  ~CorrelationReader();

  const CorrelationDescription& description() const { return description_; }
  int frame_count() const { return static_cast<int>(timestamps_s_.size()); }

  /// The frame of this index, 0 … frame_count() − 1; throws UsageError for other indices. Other
  /// faults are in `damage`. Indices in ascending order are the fastest.
  CorrelationFrame read(int index);

 private:
  struct Files;

  std::vector<FrequencyMeasurement> measure(int index);

  CorrelationDescription description_;
  std::unique_ptr<Files> files_;
  std::vector<double> timestamps_s_;
  std::vector<std::vector<ImageF>> dark_;     ///< by frequency and step; empty: a number
  std::vector<ImageF> phase_offsets_cycles_;  ///< by frequency; empty: numbers
};

}  // namespace tofmap

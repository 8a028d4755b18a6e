// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// A share of the periodic range error: cosine_m cos 2πkφ + sine_m sin 2πkφ, with k = `order`.
struct WiggleHarmonic {
  int order = 4;
  double cosine_m = 0;
  double sine_m = 0;
};

/// How much farther than the truth a camera measures at one frequency, by the phase φ that it
/// measures. Its correlation function is no pure sine: odd harmonics of it make the range swing
/// four times a wavelength and at multiples of that ("wiggling"; Lindner and Kolb 2006).
struct PhaseError {
  double offset_m = 0;
  std::vector<WiggleHarmonic> harmonics = {};
  /// Added to the above: at phases i / size, linear between them, periodic. Empty: nothing.
  std::vector<double> table_m = {};

  /// At a phase, cycles, of any whole part.
  double at_m(double phase_cycles) const;
};

/// What the recordings have in common that a calibration is of.
struct CalibratedWith {
  int width_px = 0;
  int height_px = 0;
  Modulation modulation;
};

/// What is known of one camera beyond what a recording says.
struct CameraCalibration {
  std::filesystem::path file;          ///< that it was read from, for messages; empty: from none
  std::optional<CalibratedWith> with;  ///< for no other recordings
  std::optional<CameraModel> camera;   ///< instead of the recording's
  PhaseError error_a;
  PhaseError error_b;
  double saturation_amplitude = 0;  ///< from which on a pixel counts as saturated; 0: not known
};

/// Reads a calibration (docs/calibration.md). Throws InputError that names the file, the key and
/// what is expected.
CameraCalibration read_calibration(const std::filesystem::path& file);

/// Writes it so that every number reads back as the same bits, with a comment of one line at the
/// top unless it is empty. Throws InputError if it cannot be written whole.
void write_calibration(const std::filesystem::path& file, const CameraCalibration& calibration,
                       const std::string& comment = "");

/// Whether a file is a calibration, whatever it says.
bool is_calibration(const std::filesystem::path& file);

/// The sensor with what the calibration knows better. Throws InputError if it is of a camera of
/// another size or other frequencies, or an error rises with the phase faster than a range does.
SensorModel calibrated(const SensorModel& sensor, const CameraCalibration& calibration);

/// Takes the errors out of both phases, which stay in [0, 1).
void calibrate(DualFrequencyFrame& frame, const Modulation& modulation,
               const CameraCalibration& calibration);

}  // namespace tofmap

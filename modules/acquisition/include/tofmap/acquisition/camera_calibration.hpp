// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/fixed_pattern.hpp>
#include <tofmap/core/frame.hpp>

namespace tofmap {

/// One harmonic of the periodic error of a range: cosine_m cos 2πkφ + sine_m sin 2πkφ, where k is
/// `order` and φ is the measured phase in cycles.
struct WiggleHarmonic {
  int order = 4;  ///< periods per wavelength
  double cosine_m = 0;
  double sine_m = 0;
};

/// The systematic range error at one frequency, measured minus true, as a function of the measured
/// phase φ. The periodic part arises because the correlation function of a camera is not a pure
/// sine: its odd harmonics make the error repeat four times per wavelength and at multiples of that
/// ("wiggling"; Lindner and Kolb 2006).
struct PhaseError {
  double offset_m = 0;                         ///< the same at all phases
  std::vector<WiggleHarmonic> harmonics = {};  ///< added to the offset
  /// Error at the phases i / size, added to offset and harmonics. Linear between the entries and
  /// periodic. Empty: no table.
  std::vector<double> table_m = {};

  /// The error at a phase in cycles. Whole cycles make no difference.
  double at_m(double phase_cycles) const;
};

/// Properties of the recordings from which a calibration was determined.
struct CalibratedWith {
  int width_px = 0;
  int height_px = 0;
  Modulation modulation;
};

/// The calibration of one camera, which completes or replaces the properties in a recording.
struct CameraCalibration {
  std::filesystem::path file;  ///< the file of the calibration, for messages; empty if not from one
  std::optional<CalibratedWith> with;  ///< if not empty, other recordings are refused
  std::optional<CameraModel> camera;   ///< replaces the camera of the recording, if not empty
  /// The error at each frequency; frequencies beyond the last element have none.
  std::vector<PhaseError> errors;
  /// The errors of individual pixels at each frequency, besides `errors`. Empty: none.
  FixedPattern fixed_pattern;
  /// Name of the file with `fixed_pattern`, in the folder of the calibration file. Empty: none.
  std::string fixed_pattern_file;
  /// A pixel with this amplitude or a larger one is saturated. 0: unknown; the value of the
  /// recording remains.
  double saturation_amplitude = 0;
};

/// Reads a calibration file (docs/calibration.md) and the fixed pattern beside it, if it names one.
/// Throws InputError, which names the file, the key and what is expected, if one of the files
/// cannot be read or is not valid.
CameraCalibration read_calibration(const std::filesystem::path& file);

/// Writes a calibration file in which every number reads back as the same bits. `comment` becomes
/// one line at the top, unless it is empty. The file names `fixed_pattern_file`; the pattern itself
/// is written by write_fixed_pattern(). Throws InputError if the file cannot be written completely.
void write_calibration(const std::filesystem::path& file, const CameraCalibration& calibration,
                       const std::string& comment = "");

/// True if the file says that it is a calibration of the version that read_calibration() reads.
/// Does not check the rest of the file.
bool is_calibration(const std::filesystem::path& file);

/// The name of the fixed pattern's file that a calibration file contains. Empty if it contains
/// none, or if the file is no calibration. Does not read the pattern.
std::string fixed_pattern_file_in(const std::filesystem::path& file);

/// The sensor with the camera and the saturation amplitude of the calibration, where it has them.
/// Throws InputError if the calibration or its fixed pattern is of a camera of another size or with
/// other frequencies, or if an error rises so fast with the phase that a longer range would measure
/// shorter.
SensorModel calibrated(const SensorModel& sensor, const CameraCalibration& calibration);

/// Subtracts the errors of the calibration from the phases of a frame: first the fixed pattern,
/// then the error that depends on the phase without it (docs/calibration.md, equation 1). The
/// phases stay in [0, 1); NaN stays NaN.
void calibrate(Frame& frame, const Modulation& modulation, const CameraCalibration& calibration);

}  // namespace tofmap

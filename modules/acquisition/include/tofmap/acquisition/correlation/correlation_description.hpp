// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/correlation/array_file.hpp>
#include <tofmap/acquisition/correlation/array_layout.hpp>
#include <tofmap/acquisition/correlation/step_fit.hpp>
#include <tofmap/acquisition/correlation/step_values.hpp>
#include <tofmap/core/camera.hpp>

namespace tofmap {

/// Which correlation image of a frame is meant. Both are counted from 0; −1 and −1: an image that
/// is not used.
struct StepPlace {
  int frequency = 0;
  int step = 0;
  bool operator==(const StepPlace&) const = default;
};

/// Array files and what their indices mean.
struct ArrayFiles {
  /// Name of the file, absolute or relative to the folder of the description. Fields in braces,
  /// {frame}, {frequency}, {step} and {image}, make it the pattern of many files; {frame:06} has
  /// at least six digits.
  std::string pattern;
  ArrayFileOptions options;
  std::vector<ArrayAxis> axes;               ///< of each file, in numpy's order
  std::vector<StepPlace> images;             ///< what the axis or field `image` counts; else empty
  std::vector<std::string> frequency_names;  ///< stand for {frequency}; empty: its number
  std::vector<std::string> step_names;       ///< stand for {step}; empty: its number
  int frames = 0;                            ///< number of frames; 0: as many as there are
  int first_frame = 0;                       ///< the first {frame}, if `frames` is not 0
  bool reshape = false;  ///< only the number of elements of .npy and .npz files counts
};

/// What is subtracted from the values of every correlation image.
struct DarkLevel {
  double value = 0;
  std::optional<ArrayFiles> files = {};  ///< images; empty: `value` everywhere
};

/// The unit of phase offsets in a file. Metres are metres of range.
enum class PhaseUnit { cycles, radians, metres };

/// What is subtracted from the phases of each frequency.
struct PhaseOffsets {
  std::vector<double> cycles;               ///< one number per frequency
  std::optional<ArrayFiles> files = {};     ///< one number per pixel, added to `cycles`
  PhaseUnit file_unit = PhaseUnit::cycles;  ///< of the numbers in `files`
};

/// When the frames were taken. At most one of `rate_hz`, `times_s` and `file` is given; if none is,
/// frames are a second apart.
struct FrameTimes {
  double rate_hz = 0;
  double start_s = 0;                ///< added to all times
  std::vector<double> times_s = {};  ///< of each frame
  std::filesystem::path file = {};   ///< text with one line per frame; empty: none
  int column = 0;                    ///< of the file, counted from 0
  double unit_s = 1;                 ///< of the numbers in the file
};

/// How arrays of correlation images are to be read: the content of a YAML file
/// (docs/import-correlation.md).
struct CorrelationDescription {
  std::filesystem::path file;  ///< the description itself
  CameraModel camera;
  double max_range_m = 0;                  ///< what the scene can hold; 0: unknown
  std::vector<double> frequencies_hz;      ///< one to eight, in the order of the array
  std::vector<double> exposure_offsets_s;  ///< after the timestamp; one per frequency
  std::vector<StepDesign> designs;         ///< step angles; one per frequency
  bool differential = false;               ///< values are differences of two taps (A − B)
  ArrayFiles data;
  StepValues values;
  DarkLevel dark;
  PhaseOffsets phase_offsets;
  FrameTimes times;
  double min_amplitude = 0;  ///< a pixel with less has no signal
  double max_amplitude = 0;  ///< a pixel with more is saturated; 0: no limit

  /// The number of steps of each frequency.
  std::vector<int> step_counts() const {
    std::vector<int> counts;
    for (const StepDesign& design : designs) counts.push_back(design.steps());
    return counts;
  }
};

/// Reads a description, but none of the files that it names. Throws InputError, which names the
/// file, the key, its value and what is allowed, if the description is not valid.
CorrelationDescription read_correlation_description(const std::filesystem::path& file);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/camera_calibration.hpp>
#include <tofmap/acquisition/frame_source.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// One line of frames.txt. Paths are relative to the folder of the sequence.
struct SequenceFrameFiles {
  /// A line that cannot be parsed has the timestamp of the nearest valid line before it or, at the
  /// beginning of the file, of the first valid line.
  double timestamp_s = 0;
  /// The phase image of each frequency; empty if the line cannot be parsed.
  std::vector<std::filesystem::path> phases;
  /// The amplitude image of each frequency; empty if the line does not have all of them. Amplitudes
  /// of some frequencies alone are not used: they do not tell the noise of the other phases.
  std::vector<std::filesystem::path> amplitudes;
  std::string damage;  ///< why the line cannot be used; empty if it can
};

/// Reads a sequence folder (docs/sequence-format.md) frame by frame, in any order.
///
/// A fault of the whole recording throws InputError when the folder is opened: a missing or invalid
/// sequence.yaml, or a frames.txt of which more than half of the lines cannot be parsed. A fault of
/// one frame damages that frame only: a line that cannot be parsed or whose paths lead out of the
/// folder; an image that is missing, truncated, or of another size or bit depth; a timestamp that
/// is out of order.
class SequenceReader final : public FrameSource {
 public:
  /// Reads and checks sequence.yaml and frames.txt. `calibration` is applied to all frames. Throws
  /// InputError, which names the file and the remedy, if a file is missing or invalid, if it lists
  /// no frames, or if the calibration belongs to another camera.
  explicit SequenceReader(std::filesystem::path folder, CameraCalibration calibration = {});

  const std::filesystem::path& folder() const { return folder_; }
  const CameraCalibration& calibration() const { return calibration_; }
  const SensorModel& sensor() const override { return sensor_; }

  /// Makes next() continue with the frame of this index, its position in frames.txt.
  void start_at(int index);

  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override { return static_cast<int>(files_.size()); }

  /// The frame of this index, 0 … frame_count() − 1; throws UsageError for other indices. May be
  /// called from several threads. The frame has amplitudes if frames.txt lists them for all
  /// frequencies. Phases are NaN where the amplitude is 0.
  SourcedFrame read(int index) const;

  const std::vector<SequenceFrameFiles>& files() const { return files_; }

  /// The true camera poses. Empty if the sequence has no groundtruth.txt. Throws InputError if the
  /// file is damaged.
  Trajectory ground_truth() const;

  /// The true radial ranges of a frame in metres, NaN where unknown. Empty if the sequence has no
  /// true ranges of the frame. Throws InputError if their file is damaged or not of the camera's
  /// size.
  std::optional<ImageF> range_truth(int index) const;

 private:
  const SequenceFrameFiles& files_at(int index) const;
  Frame read_frame(int index) const;

  std::filesystem::path folder_;
  CameraCalibration calibration_;
  SensorModel sensor_;
  std::vector<SequenceFrameFiles> files_;
  int next_index_ = 0;
};

/// True radial ranges as the images of range_truth/ have them, in millimetres. 0 where a range is
/// unknown, below 0.5 mm or beyond 65.535 m.
ImageU16 range_truth_pixels(const ImageF& range_m);

/// Writes a sequence folder frame by frame. After every frame the folder is a complete, readable
/// sequence, so a recording can be stopped at any time.
class SequenceWriter {
 public:
  /// Creates the folder, which must be new or empty, and writes sequence.yaml. Throws InputError if
  /// the folder or file cannot be written or `sensor` is not valid. Amplitudes are multiplied by
  /// `amplitude_scale`, which must be above 0, before they are rounded to 16 bits.
  SequenceWriter(std::filesystem::path folder, const SensorModel& sensor,
                 double amplitude_scale = 1);

  /// Writes one frame, with the ground truth as far as it is known.
  ///
  /// Throws UsageError unless the timestamp is later than that of the previous frame, all images
  /// have the camera's size, phases are in [0, 1) or NaN, and amplitudes are not negative.
  /// Amplitudes above 0 are written as 1 … 65535: 0 means no return, and 65535 that the amplitude
  /// may have been larger. True ranges below 0.5 mm or beyond 65.535 m are written as unknown.
  /// Throws InputError, which names the file, if a file cannot be written.
  void add(const Frame& frame, const std::optional<Pose>& world_from_camera = {},
           const std::optional<ImageF>& range_truth_m = {},
           const std::optional<ImageU8>& label_truth = {},
           const std::optional<ImageU8>& moving_truth = {});

  /// Number of frames written.
  int count() const { return count_; }

 private:
  std::filesystem::path folder_;
  SensorModel sensor_;
  double amplitude_scale_;
  std::ofstream frames_;
  std::ofstream ground_truth_;  ///< opened when the first pose is written
  double last_timestamp_s_;
  int count_ = 0;
};

}  // namespace tofmap

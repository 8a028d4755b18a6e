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

/// One line of frames.txt; paths are relative to the sequence, empty for '-'. Of a line that is not
/// understood paths are empty; its time is that of the line before, or of the first that is.
struct SequenceFrameFiles {
  double timestamp_s = 0;
  std::filesystem::path phase_a;
  std::filesystem::path phase_b;
  std::filesystem::path amplitude_a;
  std::filesystem::path amplitude_b;
  std::string damage;  ///< why the line cannot be used; empty if it can
};

/// Reads a sequence folder (docs/sequence-format.md) frame by frame, in any order.
///
/// What makes the whole recording unreadable throws InputError when it is opened: a missing or
/// wrong sequence.yaml, a frames.txt of which more than half cannot be understood. What spoils one
/// frame makes that frame damaged: a line that is not understood or leads out of the folder, an
/// image that is missing, truncated, of another size or depth, and a timestamp not later than the
/// frame before.
class SequenceReader final : public FrameSource {
 public:
  /// Opens the folder: reads sequence.yaml and frames.txt and checks them. Throws InputError
  /// that names the file and the remedy if either is missing or wrong, or lists no frame, or if the
  /// calibration, which is applied to all frames, is of another camera.
  explicit SequenceReader(std::filesystem::path folder, CameraCalibration calibration = {});

  const std::filesystem::path& folder() const { return folder_; }
  const CameraCalibration& calibration() const { return calibration_; }
  const SensorModel& sensor() const override { return sensor_; }
  /// The frame that next() gives next, by its place in frames.txt.
  void start_at(int index);

  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override { return static_cast<int>(files_.size()); }

  /// The frame of this index, 0 … frame_count() − 1 (UsageError beyond). May be called from
  /// several threads. Amplitudes are delivered if both images have one.
  SourcedFrame read(int index) const;

  const std::vector<SequenceFrameFiles>& files() const { return files_; }

  /// Camera poses; empty if the sequence has no groundtruth.txt.
  Trajectory ground_truth() const;

  /// True radial ranges of a frame, metres, NaN where unknown; nothing if there is no file.
  /// Throws InputError if the file is damaged or not of the camera's size.
  std::optional<ImageF> range_truth(int index) const;

 private:
  const SequenceFrameFiles& files_at(int index) const;
  DualFrequencyFrame read_frame(int index) const;

  std::filesystem::path folder_;
  CameraCalibration calibration_;
  SensorModel sensor_;
  std::vector<SequenceFrameFiles> files_;
  int next_index_ = 0;
};

/// Writes a sequence folder frame by frame. After every frame the folder is a whole, readable
/// sequence of the frames so far: a recording can be stopped at any time.
class SequenceWriter {
 public:
  /// Makes the folder, which must be new or empty, and writes sequence.yaml. Throws InputError
  /// that names the file if that is not possible, and if `sensor` is not valid. Amplitudes are
  /// multiplied by `amplitude_scale` before they are rounded to 16 bits.
  SequenceWriter(std::filesystem::path folder, const SensorModel& sensor,
                 double amplitude_scale = 1);

  /// Adds one frame, with what is known of the truth. The frame's timestamp must be later than
  /// the last one's and its images of the camera's size; phases must lie in [0, 1) or be
  /// NaN, and amplitudes must not be negative: all else is a UsageError. Amplitudes above zero are
  /// written as at least 1, since zero means no return, and at most 65535, which means that there
  /// may have been more. True ranges below 0.5 mm or beyond 65.535 m are written as unknown. Throws
  /// InputError that names the file if it cannot be written.
  void add(const DualFrequencyFrame& frame, const std::optional<Pose>& world_from_camera = {},
           const std::optional<ImageF>& range_truth_m = {},
           const std::optional<ImageU8>& label_truth = {});

  int count() const { return count_; }

 private:
  std::filesystem::path folder_;
  SensorModel sensor_;
  double amplitude_scale_;
  std::ofstream frames_;
  std::ofstream ground_truth_;  ///< opened by the first pose
  double last_timestamp_s_;
  int count_ = 0;
};

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {

/// The camera of a recording in the form of the TUM RGB-D benchmark (Sturm et al. 2012), which the
/// recording does not tell, and what is made of it. Defaults are the benchmark's own.
struct TumOptions {
  double fx_px = 525;
  double fy_px = 525;
  double cx_px = 319.5;
  double cy_px = 239.5;
  double steps_per_m = 5000;
  int every_pixel = 2;
  double reflectance = 0.5;
  double max_pose_gap_s = 0.1;

  static std::vector<OptionField<TumOptions>> fields();
};

/// Real depth as a dual-frequency camera would have measured it: depth images become radial ranges,
/// which are wrapped at both frequencies of `simulator` with its noise, wiggling, dark charge, full
/// wells, systematic errors of ranges, ambient light, phase bits and seeds, as if every surface had
/// one reflectance and faced the camera. B is taken at the instant of A. Other options of the
/// simulator need a scene.
class TumRecording {
 public:
  /// Reads depth.txt and, if it is there, groundtruth.txt, without the lines that cannot be used.
  /// Throws InputError that names the file and the remedy if the folder is no such recording, or
  /// none of its images can be read; UsageError if an option is not allowed, or would have no
  /// effect.
  TumRecording(std::filesystem::path folder, const TumOptions& options,
               const SimulatorOptions& simulator);

  const SensorModel& sensor() const { return sensor_; }
  int frame_count() const { return static_cast<int>(images_.size()); }

  /// What is wrong with the lines of depth.txt that are no frame.
  const std::vector<std::string>& left_out() const { return left_out_; }

  /// What is wrong with the lines of groundtruth.txt that are no pose.
  const std::vector<std::string>& damaged_poses() const { return damaged_poses_; }

  /// The frame of an index with its true ranges; its pose is that of groundtruth.txt.
  struct Frame {
    DualFrequencyFrame frame;
    ImageF range_truth_m;
    std::optional<Pose> world_from_camera;  ///< nothing if no pose is near in time
  };

  /// Throws InputError if its image cannot be read or is of another size than others.
  Frame read(int index) const;

  struct DepthImage {
    double timestamp_s = 0;
    std::filesystem::path file;
  };

 private:
  std::filesystem::path folder_;
  TumOptions options_;
  SensorModel sensor_;
  PixelRays rays_;
  SimulatorOptions simulator_;
  double noise_sigma_ = 0;
  std::vector<DepthImage> images_;
  std::vector<std::string> left_out_;
  std::vector<std::string> damaged_poses_;
  Trajectory poses_;
};

}  // namespace tofmap

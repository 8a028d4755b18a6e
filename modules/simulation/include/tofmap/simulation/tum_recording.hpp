// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {

/// How a recording in the format of the TUM RGB-D benchmark (Sturm et al. 2012) is converted. The
/// format does not contain the intrinsics of the camera. Their defaults are those that the
/// benchmark recommends.
struct TumOptions {
  double fx_px = 525;    ///< focal length of the depth images, 1 … 100 000 pixels
  double fy_px = 525;    ///< focal length of the depth images, 1 … 100 000 pixels
  double cx_px = 319.5;  ///< principal point of the depth images, −100 000 … 100 000 pixels
  double cy_px = 239.5;  ///< principal point of the depth images, −100 000 … 100 000 pixels

  /// Value of the depth images for a depth of one metre, 1 … 1 000 000.
  double steps_per_m = 5000;

  /// Uses every n-th pixel in both axes, 1 … 16. 1 uses all pixels.
  int every_pixel = 2;

  /// Reflectance of all surfaces, 0.01 … 1. It determines the amplitudes.
  double reflectance = 0.5;

  /// Largest time between an image and a pose that is used for it, 0 … 10 s. An image without such
  /// a pose has no true pose.
  double max_pose_gap_s = 0.1;

  static std::vector<OptionField<TumOptions>> fields();
};

/// Recorded depth, as a time-of-flight camera would have measured it. Depth images are converted to
/// radial ranges, which are wrapped at the frequencies of the simulator options, with their noise,
/// wiggling, dark charge, full wells, systematic errors, ambient light, phase bits and seeds. All
/// surfaces have the same reflectance and face the camera. All frequencies are taken at the same
/// instant. The other options of the simulator need a scene.
class TumRecording {
 public:
  /// Reads depth.txt and, if it exists, groundtruth.txt. Lines that cannot be used are left out.
  /// Throws InputError if the folder is not such a recording, if none of its images can be read, or
  /// if the camera or the frequencies are not valid. Throws UsageError, which names the option, if
  /// an option of the simulator would have no effect, or if options contradict each other.
  TumRecording(std::filesystem::path folder, const TumOptions& options,
               const SimulatorOptions& simulator);

  const SensorModel& sensor() const { return sensor_; }
  int frame_count() const { return static_cast<int>(images_.size()); }

  /// What is wrong with the lines of depth.txt that were left out, one message per line.
  const std::vector<std::string>& left_out() const { return left_out_; }

  /// What is wrong with the lines of groundtruth.txt that were left out, one message per line.
  const std::vector<std::string>& damaged_poses() const { return damaged_poses_; }

  /// A frame with its ground truth.
  struct FrameWithTruth {
    Frame frame;
    ImageF range_truth_m;  ///< NaN where there is no depth, or the range exceeds its limit
    std::optional<Pose> world_from_camera;  ///< empty if no pose is close in time
  };

  /// The frame of this index, 0 … frame_count() − 1. Throws InputError if its image cannot be read
  /// or differs in size from the other images.
  FrameWithTruth read(int index) const;

  /// An image that depth.txt lists.
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
  std::vector<DepthImage> images_;
  std::vector<std::string> left_out_;
  std::vector<std::string> damaged_poses_;
  Trajectory poses_;
};

}  // namespace tofmap

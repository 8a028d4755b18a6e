// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/frame_source.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/simulation/ideal_frame.hpp>
#include <tofmap/simulation/ray_scene.hpp>
#include <tofmap/simulation/scenes.hpp>

namespace tofmap {

struct SimulatorOptions {
  int width_px = 176;
  int height_px = 144;
  double horizontal_fov_deg = 69;
  double distortion_k1 = 0;
  double distortion_k2 = 0;
  double distortion_p1 = 0;
  double distortion_p2 = 0;
  double distortion_k3 = 0;
  double frequency_a_hz = 29e6;
  double frequency_b_hz = 31e6;
  double range_noise_m = 0.02;
  int subpixels = 3;
  double wiggle_m = 0;
  int multipath_rays = 0;
  double dark_level = 0;
  double full_well = 0;
  double exposure_share = 0;
  double offset_a_m = 0;
  double offset_b_m = 0;
  double periodic_a_m = 0;
  double periodic_b_m = 0;
  double amplitude_error_a_m = 0;
  double amplitude_error_b_m = 0;
  double fixed_pattern_m = 0;
  int errors_seed = 1;
  double ambient_noise = 1;
  double ambient_left = 0.5;
  double ambient_top = 0;
  double ambient_right = 1;
  double ambient_bottom = 0.5;
  int phase_bits = 0;
  double b_delay_share = 0.1;
  int frames = 0;
  double frame_rate_hz = 15;
  double max_translation_m = 0.07;
  double max_rotation_deg = 3;
  double max_range_m = 0;
  std::string trajectory_file;
  int seed = 1;

  static std::vector<OptionField<SimulatorOptions>> fields();
};

/// The signal of a surface of reflectance ρ at range r under the incidence angle α is
/// `amplitude_unit` ρ cos α / r² (r in metres); amplitudes end at 65535, where the sensor
/// saturates.
inline constexpr double amplitude_unit = 6000;

/// One frame with the truth behind it.
struct SimulatedFrame {
  DualFrequencyFrame frame;
  Pose world_from_camera;  ///< when A was taken
  ImageF range_truth_m;    ///< along the ray of the pixel's centre; NaN where nothing is hit
  ImageF cos_incidence;    ///< where that ray meets the surface, 0 … 1; NaN where nothing is hit
  ImageU8 label;           ///< PixelLabel as a number
};

struct PixelLight;
struct SensorEffects;
struct SensorReadout;
struct SubRay;

/// A dual-frequency time-of-flight camera on a path through a scene (docs/simulator.md).
///
/// Each pixel is the mean of the complex signals of a grid of rays over its area, at each
/// frequency, plus complex Gaussian noise of one strength: phase noise goes as 1 / amplitude,
/// and pixels on an edge mix the surfaces on both sides, as in a real sensor. No ray hits, or
/// an amplitude that rounds to zero: no return. Harmonics of the correlation function, light by way
/// of other surfaces, dark charge, full wells and motion during an exposure come in by options, and
/// so do systematic errors of ranges, ambient light and quantised phases. The same scene, options
/// and seeds give the same bits, whatever the number of threads.
class Simulator final : public FrameSource {
 public:
  /// `keep_going` is asked at every row of an image, from several threads; once it says no, the
  /// frame being made is the last, and unfinished. Throws UsageError if an option is not allowed,
  /// InputError if the trajectory cannot be read.
  Simulator(Scene scene, const SimulatorOptions& options, std::function<bool()> keep_going = {});

  /// Its max_range_m is the option's: a camera does not know how large the scene is.
  const SensorModel& sensor() const override { return sensor_; }

  /// Nothing at the end, and once it is not to keep going.
  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override { return static_cast<int>(motion_.at_a.size()); }

  /// The frame of this index, 0 … frame_count() − 1, in any order. It is unfinished if
  /// is_stopped() afterwards.
  SimulatedFrame simulate(int index) const;

  /// The same frame before the sensor reads it: to measure one place with many errors and noises
  /// (measured_frame()) without casting rays anew.
  IdealFrame ideal(int index) const;

  bool is_stopped() const { return keep_going_ && !keep_going_(); }

  /// Camera poses at the instants of A.
  const Trajectory& trajectory() const { return motion_.at_a; }

  const TriangleMesh& surface() const { return scene_.surface; }
  const RayScene& rays() const { return ray_scene_; }

  /// Standard deviation of the noise of either component of the complex signal, in the units
  /// of the amplitude, where no ambient light falls; a pixel's phase noise is noise_sigma() /
  /// amplitude radians.
  double noise_sigma() const { return noise_sigma_; }

 private:
  struct Exposure;
  struct Exposed;
  void check_index(int index) const;
  Exposure exposure_a(int index) const;
  Exposure exposure_b(int index) const;
  Exposure exposure_of(const Trajectory& poses, int index, double wavelength_m,
                       std::uint64_t key) const;
  template <class Visit>
  void for_each_signal(const Exposure& exposure, const Visit& visit) const;
  ImageC ideal_signals(const Exposure& exposure) const;
  Exposed expose(const Exposure& exposure, const SensorReadout& readout, bool with_labels) const;
  PixelLight light_of(std::size_t pixel, const Exposure& exposure, const Pose& world_from_camera,
                      std::vector<SubRay>& rays) const;
  std::optional<std::complex<double>> ideal_signal(std::size_t pixel, const Exposure& exposure,
                                                   const SensorEffects& effects,
                                                   std::vector<SubRay>& rays) const;
  struct Truth;
  Truth cast_truth(const Pose& world_from_camera) const;

  Scene scene_;
  SimulatorOptions options_;
  SensorModel sensor_;
  double reach_m_ = 0;  ///< rays end here
  RayScene ray_scene_;
  CameraMotion motion_;
  std::vector<Eigen::Vector3f> rays_;  ///< camera frame; all of a pixel's together, row by row
  double noise_sigma_ = 0;
  int next_index_ = 0;
  std::function<bool()> keep_going_;
};

/// Writes all frames with groundtruth.txt, range_truth/ and scene.ply into a new or empty folder.
/// `keep_going(done, total)` is asked before each frame; when it returns false, or the simulator is
/// stopped, what was finished stays as a whole sequence. Returns how many frames were written.
int simulate_sequence(const Simulator& simulator, const std::filesystem::path& folder,
                      const std::function<bool(int done, int total)>& keep_going = {});

}  // namespace tofmap

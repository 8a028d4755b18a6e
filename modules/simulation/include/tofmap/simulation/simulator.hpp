// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tofmap/acquisition/frame_source.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/simulation/ideal_frame.hpp>
#include <tofmap/simulation/moving_bodies.hpp>
#include <tofmap/simulation/ray_scene.hpp>
#include <tofmap/simulation/scenes.hpp>

namespace tofmap {

/// Where people walk in a simulated scene.
enum class PeoplePaths : std::uint8_t {
  ahead,  ///< to and fro ahead of the camera, whose pace they keep
  own,    ///< to and fro on lines through the free space of the scene
  both,   ///< the first, third … person ahead of the camera, the others on lines of their own
};

std::span<const NamedValue<PeoplePaths>> named_values(PeoplePaths);

/// Options of the simulated camera (docs/simulator.md, to which equations refer). By default its
/// only errors are noise, mixed pixels and the motion between A and B.
struct SimulatorOptions {
  // The image. Pixels are square, and the optical axis passes through the image centre.

  int width_px = 176;              ///< image width, 8 … 4096 pixels
  int height_px = 144;             ///< image height, 8 … 4096 pixels
  double horizontal_fov_deg = 69;  ///< horizontal field of view, 1 … 150 degrees

  double distortion_k1 = 0;  ///< radial distortion k1 of OpenCV, −10 … 10
  double distortion_k2 = 0;  ///< radial distortion k2 of OpenCV, −10 … 10
  double distortion_p1 = 0;  ///< tangential distortion p1 of OpenCV, −1 … 1
  double distortion_p2 = 0;  ///< tangential distortion p2 of OpenCV, −1 … 1
  double distortion_k3 = 0;  ///< radial distortion k3 of OpenCV, −10 … 10

  double frequency_a_hz = 29e6;  ///< modulation frequency of image A, 1e6 … 1e9 Hz
  double frequency_b_hz = 31e6;  ///< modulation frequency of image B, 1e6 … 1e9 Hz

  /// One to eight modulation frequencies in place of A's and B's, 1e6 … 1e9 Hz. Empty: A and B.
  /// Options of A apply to the first one, options of B to the second one.
  std::vector<double> frequencies_hz;

  /// Factor of the signal at each frequency, 0.01 … 1: cameras demodulate high frequencies less
  /// well. Frequencies beyond the end of the list have 1.
  std::vector<double> contrasts;

  /// Noise: standard deviation of A's range for a surface of reflectance 0.5 that faces the camera
  /// at 5 m, 0 … 10 m (equation 4). The noise of the signal is the same in all pixels and at both
  /// frequencies.
  double range_noise_m = 0.02;

  /// Rays per pixel along each of its sides, 1 … 16. The signal of a pixel is their mean, so that
  /// pixels at edges mix surfaces.
  int subpixels = 3;

  // Light and charge.

  /// Amplitude of the wiggling of A's ranges, which repeats four times per wavelength, 0 … 0.2 m.
  /// The phase error of B, in degrees, is the same.
  double wiggle_m = 0;

  /// Rays per pixel for multipath light, which reaches the pixel by way of one other surface,
  /// 0 … 4096. 0: no multipath.
  int multipath_rays = 0;

  /// Charge of a sample without light, in units of the amplitude, 0 … 65535. It fills part of the
  /// well and adds shot noise (equation 8).
  double dark_level = 0;

  /// Largest charge that a sample can hold, in units of the amplitude, 0 … 1e6. 0: no limit.
  double full_well = 0;

  /// Time over which the four samples of an image are taken, as a fraction of the frame period,
  /// 0 … 1. The camera moves between the samples. 0: all are taken at once.
  double exposure_share = 0;

  // Systematic errors of ranges, measured minus true.

  double offset_a_m = 0;  ///< constant error of A's ranges, −0.2 … 0.2 m
  double offset_b_m = 0;  ///< constant error of B's ranges, −0.2 … 0.2 m

  /// Largest periodic error of A's ranges, which has two harmonics of 2 and 4 periods per
  /// wavelength, 0 … 0.2 m (equation 10).
  double periodic_a_m = 0;
  /// Largest periodic error of B's ranges, which has two harmonics of 2 and 4 periods per
  /// wavelength, 0 … 0.2 m (equation 10).
  double periodic_b_m = 0;

  /// Error of A's ranges at amplitudes of 60 and below, −0.2 … 0.2 m. It decreases with the
  /// logarithm of the amplitude, to 0 at 60000 (equation 11).
  double amplitude_error_a_m = 0;
  /// Error of B's ranges at amplitudes of 60 and below, −0.2 … 0.2 m. It decreases with the
  /// logarithm of the amplitude, to 0 at 60000 (equation 11).
  double amplitude_error_b_m = 0;

  /// Lists of the three errors above for all frequencies; a list replaces the values of A and B.
  /// Frequencies beyond the end of a list have no such error.
  std::vector<double> offsets_m;
  std::vector<double> periodic_errors_m;   ///< see `offsets_m`
  std::vector<double> amplitude_errors_m;  ///< see `offsets_m`

  /// Standard deviation of the constant errors of individual pixels, which differ between the
  /// frequencies, 0 … 0.2 m (equation 12).
  double fixed_pattern_m = 0;

  /// Seed of periodic errors and fixed pattern, 0 or larger. It identifies the individual camera.
  int errors_seed = 1;

  // Ambient light.

  /// Factor by which ambient light increases the noise, 1 … 20. 1: no ambient light.
  double ambient_noise = 1;

  double ambient_left = 0.5;  ///< left edge of the lit rectangle, fraction of the width, 0 … 1
  double ambient_top = 0;     ///< upper edge of the lit rectangle, fraction of the height, 0 … 1
  double ambient_right = 1;   ///< right edge of the lit rectangle, fraction of the width, 0 … 1
  double ambient_bottom = 0.5;  ///< lower edge of the lit rectangle, fraction of the height, 0 … 1

  // Quantisation.

  /// Rounds phases to 2^phase_bits levels per cycle, 4 … 16. 0: no rounding. 1 to 3 are refused.
  int phase_bits = 0;

  // Motion.

  /// Time from the first image of a frame to the last, as a fraction of the frame period, 0 … 1.
  /// The images between them are evenly spaced.
  double b_delay_share = 0.1;

  /// Number of frames, 0 … 1 000 000. 0: as many as the path or the trajectory file needs. More
  /// frames than the path needs make the camera move more slowly.
  int frames = 0;

  /// Frames per second, 0.01 … 10 000 Hz. A trajectory file has its own timestamps.
  double frame_rate_hz = 15;

  /// Largest translation of the camera from frame to frame on the scene's path, 0.001 … 10 m.
  double max_translation_m = 0.07;

  /// Largest rotation of the camera from frame to frame on the scene's path, 0.01 … 90 degrees.
  double max_rotation_deg = 3;

  /// Surfaces beyond this range return no signal, 0 … 65.5 m. The recording states the limit, which
  /// helps unwrapping. 0: all surfaces return a signal, and the recording states no limit.
  double max_range_m = 0;

  /// File of camera poses in TUM format, one per frame, which replace the path of the scene. Empty:
  /// the path of the scene.
  std::string trajectory_file;

  /// Seed of another walk through the scene, 0 or larger (other_walk()). 0: the path of the scene.
  /// It must be 0 if there is a trajectory file.
  int walk = 0;

  // Furniture.

  /// Number of pieces of furniture that are taken away, put in anew or moved, 0 … 50
  /// (tofmap/simulation/rearrangement.hpp). There are fewer where the scene lacks furniture and
  /// free floor in view.
  int rearranged = 0;

  /// Seed of what is rearranged and where, 0 or larger.
  int arrangement = 1;

  // What moves.

  /// Largest number of people, 0 … 8. There are fewer where the scene lacks free space.
  int people = 0;

  PeoplePaths people_paths = PeoplePaths::ahead;  ///< where people walk

  /// Mean horizontal range from the camera to the first person who walks ahead of it, 0.8 … 10 m.
  /// Each further one walks 30 % of it farther away.
  double people_range_m = 1.7;

  /// Largest number of doors that open and shut, 0 … 8. There are fewer where walls lack the space.
  int doors = 0;

  /// Seed of the noise, of people and of doors, 0 or larger. The program and the device also use it
  /// for the room of the scene `random`.
  int seed = 1;

  static std::vector<OptionField<SimulatorOptions>> fields();
};

/// The amplitude of a surface of reflectance ρ at the range r, in metres, and the angle of
/// incidence α is `amplitude_unit` ρ cos α / r². Larger amplitudes than 65535 are recorded as
/// 65535.
inline constexpr double amplitude_unit = 6000;

/// One frame with its ground truth.
struct SimulatedFrame {
  Frame frame;
  Pose world_from_camera;  ///< when the first image is taken
  ImageF range_truth_m;    ///< along the ray of the pixel's centre; NaN if it meets no surface
  ImageF cos_incidence;    ///< of that ray at the surface, 0 … 1; NaN if it meets no surface
  ImageU8 label;           ///< PixelLabel as a number
  /// 255 where that ray meets what moves, otherwise 0. Empty if nothing moves in the recording.
  ImageU8 moving;
};

struct PixelLight;
struct SceneAtTime;
struct SensorEffects;
struct SensorReadout;
struct SubRay;

/// A time-of-flight camera with one to eight frequencies on a path through a scene
/// (docs/simulator.md).
///
/// At each frequency, the signal of a pixel is the mean of the complex signals of a grid of rays
/// over its area, plus complex Gaussian noise whose strength does not depend on the signal. So
/// phase noise is inversely proportional to the amplitude, and pixels at an edge mix the surfaces
/// on both sides, as in a real sensor. A pixel has no return if no ray meets a surface, or if the
/// amplitude rounds to zero. Options add harmonics of the correlation function, multipath light,
/// dark charge, full wells, motion during an exposure, systematic errors of ranges, ambient light
/// and quantised phases. The same scene, options and seeds give the same bits, whatever the number
/// of threads.
class Simulator final : public FrameSource {
 public:
  /// `keep_going` is called before every row of an image, from several threads. Once it returns
  /// false, the present frame stays unfinished, and next() returns no more frames. Throws
  /// UsageError if an option is not allowed, the scene has no triangle, or a trajectory file is
  /// combined with `walk` or leads through rearranged furniture, and InputError if that file cannot
  /// be read or has no poses.
  Simulator(Scene scene, const SimulatorOptions& options, std::function<bool()> keep_going = {});

  /// The sensor. Its max_range_m is that of the options: a camera does not know the size of the
  /// scene.
  const SensorModel& sensor() const override { return sensor_; }

  /// The next frame. Empty at the end, or if `keep_going` returned false.
  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override { return static_cast<int>(trajectory().size()); }

  /// The frame of this index, 0 … frame_count() − 1. Frames may be simulated in any order. The
  /// frame is unfinished if is_stopped() is true afterwards. Throws UsageError if there is no such
  /// frame.
  SimulatedFrame simulate(int index) const;

  /// The signals of the frame of this index before the sensor measures them. measured_frame() makes
  /// frames with other noise and errors from them, without casting rays again. Throws UsageError if
  /// there is no such frame.
  IdealFrame ideal(int index) const;

  /// Whether `keep_going` now returns false.
  bool is_stopped() const { return keep_going_ && !keep_going_(); }

  /// Camera poses when the first image of each frame is taken.
  const Trajectory& trajectory() const { return motion_.at.front(); }

  /// The surface that does not move, with the frames of doors.
  const TriangleMesh& surface() const { return scene_.surface; }

  /// The furniture of the scene, which is part of surface().
  const std::vector<FurniturePiece>& furniture() const { return scene_.furniture; }
  const RayScene& rays() const { return ray_scene_; }

  /// What moves.
  const MovingBodies& bodies() const { return bodies_; }

  /// Standard deviation of the noise of each component of the complex signal, in units of the
  /// amplitude, without ambient light and dark charge. The phase noise of a pixel is noise_sigma()
  /// / amplitude, radians.
  double noise_sigma() const { return noise_sigma_; }

 private:
  struct Exposure;
  struct Exposed;
  void check_index(int index) const;
  Exposure exposure(int index, std::size_t frequency) const;
  double time_s(int index, double share) const;
  SceneAtTime scene_at(double time_s) const;
  template <class Visit>
  void for_each_signal(const Exposure& exposure, const Visit& visit) const;
  ImageC ideal_signals(const Exposure& exposure) const;
  Exposed expose(const Exposure& exposure, const SensorReadout& readout, bool with_labels) const;
  PixelLight light_of(std::size_t pixel, const Exposure& exposure, std::size_t sample,
                      std::vector<SubRay>& rays) const;
  std::optional<std::complex<double>> ideal_signal(std::size_t pixel, const Exposure& exposure,
                                                   const SensorEffects& effects,
                                                   std::vector<SubRay>& rays) const;
  struct Truth;
  Truth cast_truth(int index) const;

  SimulatorOptions options_;
  Scene scene_;  ///< with its furniture rearranged, and the walk of the options
  SensorModel sensor_;
  double reach_m_ = 0;  ///< range at which rays end
  CameraMotion motion_;
  MovingBodies bodies_;
  RayScene ray_scene_;
  std::vector<Eigen::Vector3f> rays_;  ///< camera frame; row by row, the rays of a pixel together
  double noise_sigma_ = 0;
  int next_index_ = 0;
  std::function<bool()> keep_going_;
};

/// Writes all frames as a sequence, with groundtruth.txt, range_truth/, label_truth/, scene.ply,
/// furniture.json and, if something moves, moving_truth/, into a new or empty folder.
/// `keep_going(done, total)` is called before each frame. If it returns false, or if the simulator
/// is stopped, the frames so far remain as a complete sequence. Returns the number of frames
/// written. Throws InputError if a file cannot be written.
int simulate_sequence(const Simulator& simulator, const std::filesystem::path& folder,
                      const std::function<bool(int done, int total)>& keep_going = {});

}  // namespace tofmap

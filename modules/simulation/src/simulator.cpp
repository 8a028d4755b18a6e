// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/simulator.hpp"

#include "noise.hpp"
#include "pixel_signal.hpp"
#include "scene_at_time.hpp"
#include "sensor_effects.hpp"
#include "sensor_readout.hpp"
#include "simulator_options.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/simulation/pixel_label.hpp>
#include <tofmap/simulation/rearrangement.hpp>

namespace tofmap {
namespace {

SensorModel sensor_model(const SimulatorOptions& options) {
  SensorModel sensor;
  CameraModel& camera = sensor.camera;
  camera = pinhole_camera(options.horizontal_fov_deg * std::numbers::pi / 180, options.width_px,
                          options.height_px);
  camera.distortion = {options.distortion_k1, options.distortion_k2, options.distortion_p1,
                       options.distortion_p2, options.distortion_k3};
  sensor.modulation = modulation_of(options);
  sensor.max_range_m = options.max_range_m;
  try {
    validate(camera);
    validate(sensor.modulation);
  } catch (const InputError& error) {  // the values come from options, not from a file
    throw UsageError(std::string("simulator options: ") + error.what());
  }
  return sensor;
}

/// The rays through a grid of n x n points over the square of each pixel, row by row.
std::vector<Eigen::Vector3f> subpixel_rays(const CameraModel& camera, int n) {
  std::vector<Eigen::Vector3f> rays;
  rays.reserve(static_cast<std::size_t>(camera.width_px) * camera.height_px * n * n);
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      for (int i = 0; i < n * n; ++i) {
        const int row = i / n;
        const int col = i % n;
        const double du = (col + 0.5) / n - 0.5;
        const double dv = (row + 0.5) / n - 0.5;
        rays.push_back(pixel_ray(camera, u + du, v + dv).cast<float>());
      }
    }
  }
  return rays;
}

/// When each image of a frame is taken, as a fraction of the frame period after its timestamp.
std::vector<double> delay_shares(const SimulatorOptions& options) {
  const std::size_t count = modulation_of(options).count();
  std::vector<double> shares{0};
  for (std::size_t f = 1; f < count; ++f) {
    shares.push_back(options.b_delay_share * static_cast<double>(f) /
                     static_cast<double>(count - 1));
  }
  return shares;
}

CameraMotion camera_motion(const Scene& scene, const SimulatorOptions& options) {
  if (!options.trajectory_file.empty()) {
    const Trajectory poses = read_trajectory(options.trajectory_file);
    if (poses.empty()) throw InputError(options.trajectory_file + ": contains no poses");
    return replay_motion(poses, options.frames, delay_shares(options));
  }
  const MotionLimits limits{options.max_translation_m,
                            options.max_rotation_deg * std::numbers::pi / 180};
  return plan_motion(scene.path, limits, options.frames, scene.min_frames, options.frame_rate_hz,
                     delay_shares(options));
}

/// The scene with its furniture rearranged and with the walk of the options.
Scene arranged(Scene scene, const SimulatorOptions& options) {
  if (options.walk != 0 && !options.trajectory_file.empty()) {
    throw UsageError(
        "simulator.walk varies the path of the scene, which simulator.trajectory_file replaces; "
        "leave one of them out");
  }
  scene = rearranged(std::move(scene), options.rearranged, options.arrangement);
  if (options.walk == 0) return scene;
  scene.path = other_walk(scene, options.walk);
  // The walk may lead farther away from surfaces than the path of the scene.
  constexpr double max_written_range_m = 65.5;
  scene.max_range_m = std::max(
      scene.max_range_m, std::min(bounds(scene.surface).diagonal().norm(), max_written_range_m));
  return scene;
}

/// Throws UsageError if a pose is inside a piece that was put in or moved.
void refuse_way_through_furniture(const Trajectory& poses,
                                  const std::vector<FurniturePiece>& furniture) {
  for (const FurniturePiece& piece : furniture) {
    if (piece.state != PieceState::added && piece.state != PieceState::moved) continue;
    for (const StampedPose& pose : poses) {
      if (!piece.box.contains(pose.world_from_camera.translation())) continue;
      throw UsageError("simulator.trajectory_file leads through the rearranged piece '" +
                       piece.name + "'; choose another simulator.arrangement");
    }
  }
}

/// The rays of a scene, to whose surface the frames of doors are added.
RayScene with_frames(Scene& scene, const MovingBodies& bodies) {
  bodies.add_frames(scene.surface);
  return RayScene(scene.surface);
}

}  // namespace

Simulator::Simulator(Scene scene, const SimulatorOptions& options, std::function<bool()> keep_going)
    : options_(checked_options(options)),
      scene_(arranged(std::move(scene), options_)),
      sensor_(sensor_model(options_)),
      reach_m_(options_.max_range_m > 0 ? options_.max_range_m : scene_.max_range_m),
      motion_(camera_motion(scene_, options_)),
      bodies_(scene_.surface, trajectory(), sensor_.camera, options_),
      ray_scene_(with_frames(scene_, bodies_)),
      rays_(subpixel_rays(sensor_.camera, options_.subpixels)),
      noise_sigma_(noise_strength(options_.range_noise_m, sensor_.modulation)),
      keep_going_(std::move(keep_going)) {
  if (!options_.trajectory_file.empty()) refuse_way_through_furniture(trajectory(), furniture());
}

std::optional<SourcedFrame> Simulator::next() {
  if (next_index_ >= *frame_count()) return std::nullopt;
  SourcedFrame sourced;
  sourced.index = next_index_;
  sourced.frame = simulate(next_index_++).frame;
  if (is_stopped()) return std::nullopt;
  sourced.timestamp_s = sourced.frame->timestamp_s;
  return sourced;
}

/// The poses of the camera while it takes one image, and what else rays depend on.
struct Simulator::Exposure {
  // At each of the four samples. All are the same if the exposure takes no time.

  std::array<Pose, 4> world_from_camera;
  std::array<SceneAtTime, 4> scene;
  bool stands_still = true;  ///< the four poses are the same
  double wavelength_m = 0;
  std::uint64_t noise_key = 0;  ///< seed of the directions of multipath rays
};

/// One image as the sensor measures it.
struct Simulator::Exposed {
  ImageF phase;      ///< cycles; NaN without a return
  ImageF amplitude;  ///< 0 without a return
  ImageU8 label;     ///< PixelLabel as a number; 0 everywhere if labels are not wanted
};

/// The true geometry along the rays of the pixel centres. NaN if a ray meets no surface.
struct Simulator::Truth {
  ImageF range_m;
  ImageF cos_incidence;
  ImageU8 moving;  ///< 255 where the ray meets what moves, otherwise 0
};

void Simulator::check_index(int index) const {
  if (index >= 0 && index < *frame_count()) return;
  throw UsageError("frame " + std::to_string(index) + " of the simulation does not exist; there " +
                   "are frames 0 to " + std::to_string(*frame_count() - 1));
}

SimulatedFrame Simulator::simulate(int index) const {
  check_index(index);
  const StampedPose& first = trajectory()[static_cast<std::size_t>(index)];
  SimulatedFrame simulated;
  Frame& frame = simulated.frame;
  frame.index = index;
  frame.timestamp_s = first.timestamp_s;
  for (std::size_t f = 0; f < sensor_.modulation.count(); ++f) {
    const SensorReadout readout = sensor_readout(options_, sensor_, index, f);
    Exposed exposed = expose(exposure(index, f), readout, f == 0);
    // A pixel without a return at one of the frequencies has no range.
    simulated.label = f == 0
                          ? std::move(exposed.label)
                          : ImageU8(exposed.phase.isNaN().select(
                                static_cast<std::uint8_t>(PixelLabel::no_return), simulated.label));
    frame.phases.push_back(std::move(exposed.phase));
    frame.amplitudes.push_back(std::move(exposed.amplitude));
  }
  simulated.world_from_camera = first.world_from_camera;
  Truth truth = cast_truth(index);
  simulated.range_truth_m = std::move(truth.range_m);
  simulated.cos_incidence = std::move(truth.cos_incidence);
  if (!bodies_.are_none()) simulated.moving = std::move(truth.moving);
  return simulated;
}

IdealFrame Simulator::ideal(int index) const {
  check_index(index);
  const StampedPose& first = trajectory()[static_cast<std::size_t>(index)];
  IdealFrame ideal{.index = index,
                   .timestamp_s = first.timestamp_s,
                   .signals = {},
                   .world_from_camera = first.world_from_camera,
                   .range_truth_m = cast_truth(index).range_m};
  for (std::size_t f = 0; f < sensor_.modulation.count(); ++f) {
    ideal.signals.push_back(ideal_signals(exposure(index, f)));
  }
  return ideal;
}

/// The time `share` of a frame period after the timestamp of a frame.
double Simulator::time_s(int index, double share) const {
  const Trajectory& poses = trajectory();
  const auto i = static_cast<std::size_t>(index);
  if (poses.size() == 1) return poses[i].timestamp_s + share / options_.frame_rate_hz;
  const std::size_t from = std::min(i, poses.size() - 2);
  return poses[i].timestamp_s + share * (poses[from + 1].timestamp_s - poses[from].timestamp_s);
}

SceneAtTime Simulator::scene_at(double time_s) const {
  if (bodies_.are_none()) return {&ray_scene_, nullptr};
  const TriangleMesh surface = bodies_.surface_at(time_s);
  if (surface.triangles.empty()) return {&ray_scene_, nullptr};
  return {&ray_scene_, std::make_shared<const RayScene>(surface)};
}

/// The exposure of the image at one frequency. Its four samples are evenly spaced around the time
/// of the image.
Simulator::Exposure Simulator::exposure(int index, std::size_t frequency) const {
  const Trajectory& poses = motion_.at[frequency];
  const double delay_share = delay_shares(options_)[frequency];
  Exposure exposure;
  exposure.wavelength_m = sensor_.modulation.wavelength_m(frequency);
  exposure.noise_key = noise_key(options_, index, frequency, sensor_.modulation.count());
  const auto i = static_cast<std::size_t>(index);
  if (options_.exposure_share == 0 || poses.size() == 1) {
    exposure.world_from_camera.fill(poses[i].world_from_camera);
    exposure.scene.fill(scene_at(time_s(index, delay_share)));
    return exposure;
  }
  exposure.stands_still = false;
  const bool is_last = i + 1 == poses.size();
  const Pose& from = poses[is_last ? i - 1 : i].world_from_camera;
  const Pose& to = poses[is_last ? i : i + 1].world_from_camera;
  for (std::size_t k = 0; k < 4; ++k) {
    const double off_share = options_.exposure_share * (static_cast<double>(k) - 1.5) / 4;
    exposure.world_from_camera[k] = interpolate(from, to, (is_last ? 1 : 0) + off_share);
    exposure.scene[k] = scene_at(time_s(index, delay_share + off_share));
  }
  return exposure;
}

/// The light that reaches one pixel at one sample. Sets the directions and hits of `rays`.
PixelLight Simulator::light_of(std::size_t pixel, const Exposure& exposure, std::size_t sample,
                               std::vector<SubRay>& rays) const {
  const Pose& world_from_camera = exposure.world_from_camera[sample];
  const SceneAtTime& scene = exposure.scene[sample];
  const Eigen::Matrix3d turn = world_from_camera.linear();
  const Eigen::Vector3d origin = world_from_camera.translation();
  PixelLight light;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SubRay& ray = rays[i];
    ray.direction = turn * rays_[pixel * rays.size() + i].cast<double>();
    ray.hit = scene.cast(origin, ray.direction, reach_m_);
    if (!ray.hit) continue;
    const RayHit& hit = *ray.hit;
    const double strength =
        amplitude_unit * hit.reflectance * hit.cos_incidence / (hit.range_m * hit.range_m);
    light += light_from(strength, hit.range_m, exposure.wavelength_m);
  }
  light = light / static_cast<double>(rays.size());
  const SubRay& middle = rays[rays.size() / 2];
  if (options_.multipath_rays > 0 && middle.hit) {
    const std::uint64_t key = mix(exposure.noise_key ^ mix(pixel));
    const Lamp lamp{sensor_.camera, world_from_camera, reach_m_};
    light += indirect_light(scene, lamp, middle.direction, *middle.hit, options_.multipath_rays,
                            key, exposure.wavelength_m);
  }
  return light;
}

/// The signal of one pixel without noise and range errors. Empty if no ray meets a surface. Sets
/// the directions and hits of `rays`.
std::optional<std::complex<double>> Simulator::ideal_signal(std::size_t pixel,
                                                            const Exposure& exposure,
                                                            const SensorEffects& effects,
                                                            std::vector<SubRay>& rays) const {
  std::array<PixelLight, 4> samples;
  samples.fill(light_of(pixel, exposure, 0, rays));
  for (std::size_t k = 1; k < samples.size() && !exposure.stands_still; ++k) {
    samples[k] = light_of(pixel, exposure, k, rays);
  }
  const bool any_hit =
      std::ranges::any_of(rays, [](const SubRay& ray) { return ray.hit.has_value(); }) ||
      std::ranges::any_of(samples, [](const PixelLight& light) { return light.level > 0; });
  if (!any_hit) return std::nullopt;
  return effects.are_none() && exposure.stands_still ? samples[0].first
                                                     : demodulate(samples, effects);
}

/// Calls `visit(row, col, signal, rays)` for every pixel that sees a surface, from several threads.
template <class Visit>
void Simulator::for_each_signal(const Exposure& exposure, const Visit& visit) const {
  const int rows = sensor_.camera.height_px;
  const int cols = sensor_.camera.width_px;
  const auto rays_per_pixel = static_cast<std::size_t>(options_.subpixels * options_.subpixels);
  const SensorEffects effects = sensor_effects(options_, sensor_.modulation);
#pragma omp parallel for schedule(dynamic)
  for (int v = 0; v < rows; ++v) {
    if (is_stopped()) continue;
    std::vector<SubRay> rays(rays_per_pixel);
    for (int u = 0; u < cols; ++u) {
      const std::size_t pixel = static_cast<std::size_t>(v) * cols + u;
      const auto signal = ideal_signal(pixel, exposure, effects, rays);
      if (signal) visit(v, u, *signal, rays);
    }
  }
}

ImageC Simulator::ideal_signals(const Exposure& exposure) const {
  const std::complex<double> nothing(std::numeric_limits<double>::quiet_NaN(), 0);
  ImageC out = ImageC::Constant(sensor_.camera.height_px, sensor_.camera.width_px, nothing);
  for_each_signal(exposure, [&](int v, int u, const std::complex<double>& signal,
                                const std::vector<SubRay>&) { out(v, u) = signal; });
  return out;
}

Simulator::Exposed Simulator::expose(const Exposure& exposure, const SensorReadout& readout,
                                     bool with_labels) const {
  const int rows = sensor_.camera.height_px;
  const int cols = sensor_.camera.width_px;
  Exposed out{ImageF::Constant(rows, cols, nan), ImageF::Zero(rows, cols),
              ImageU8::Zero(rows, cols)};
  for_each_signal(exposure, [&](int v, int u, const std::complex<double>& signal,
                                const std::vector<SubRay>& rays) {
    const auto pixel = readout.read(signal, v, u);
    if (!pixel) return;
    out.amplitude(v, u) = pixel->measured.amplitude;
    out.phase(v, u) = pixel->measured.phase_cycles;
    if (!with_labels) return;
    // Labels ignore the systematic errors.
    const auto without_errors = measure(pixel->signal_without_errors).value_or(pixel->measured);
    out.label(v, u) = static_cast<std::uint8_t>(label_pixel(
        rays, without_errors.phase_cycles, exposure.wavelength_m, pixel->range_sigma_m));
  });
  return out;
}

Simulator::Truth Simulator::cast_truth(int index) const {
  const Pose& world_from_camera = trajectory()[static_cast<std::size_t>(index)].world_from_camera;
  const SceneAtTime scene = scene_at(time_s(index, 0));
  const ImageF nothing = ImageF::Constant(sensor_.camera.height_px, sensor_.camera.width_px, nan);
  Truth truth{nothing, nothing, ImageU8::Zero(nothing.rows(), nothing.cols())};
  for (int v = 0; v < sensor_.camera.height_px && !is_stopped(); ++v) {
    for (int u = 0; u < sensor_.camera.width_px; ++u) {
      const Eigen::Vector3d ray = world_from_camera.linear() * pixel_ray(sensor_.camera, u, v);
      const auto hit = scene.cast(world_from_camera.translation(), ray, reach_m_);
      if (!hit) continue;
      truth.range_m(v, u) = static_cast<float>(hit->range_m);
      truth.cos_incidence(v, u) = static_cast<float>(hit->cos_incidence);
      truth.moving(v, u) = hit->is_moving ? 255 : 0;
    }
  }
  return truth;
}

int simulate_sequence(const Simulator& simulator, const std::filesystem::path& folder,
                      const std::function<bool(int done, int total)>& keep_going) {
  SequenceWriter writer(folder, simulator.sensor());
  write_mesh_ply(folder / "scene.ply", simulator.surface());
  write_furniture(folder / "furniture.json", simulator.furniture());
  const int total = *simulator.frame_count();
  for (int i = 0; i < total; ++i) {
    if (keep_going && !keep_going(i, total)) break;
    const SimulatedFrame simulated = simulator.simulate(i);
    if (simulator.is_stopped()) break;
    writer.add(simulated.frame, simulated.world_from_camera, simulated.range_truth_m,
               simulated.label,
               simulator.bodies().are_none() ? std::nullopt : std::optional(simulated.moving));
  }
  return writer.count();
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "recordings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <tofmap/simulation/scenes.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::bench {
namespace {

using Eigen::Vector3d;

SimulatorOptions simulator_options(const Recording& recording) {
  SimulatorOptions options;
  options.width_px = recording.width_px;
  options.height_px = recording.width_px * 144 / 176;
  options.range_noise_m = recording.range_noise_m;
  options.subpixels = recording.subpixels;
  options.wiggle_m = recording.wiggle_m;
  return options;
}

/// A path of 3 cm in front of a surface that is visible from the path of the scene.
CameraPath step_near_wall(const Scene& scene, const RayScene& rays, std::mt19937& random) {
  constexpr double clearance_m = 0.25;
  constexpr double step_m = 0.03;
  std::uniform_real_distribution<double> share(0, 1);
  const Vector3d up = Vector3d::UnitZ();
  while (true) {
    const Vector3d place = scene.path.pose_at(share(random) * scene.path.end()).translation();
    const double yaw = 2 * std::numbers::pi * share(random);
    const Vector3d ahead(std::cos(yaw), std::sin(yaw), 0);
    const auto hit = rays.cast(place, ahead, scene.max_range_m);
    const double gap_m = 0.3 + 0.7 * share(random);
    const double turn = (share(random) - 0.5) * std::numbers::pi;
    const double pitch = 0.4 * (share(random) - 0.5);
    if (!hit || hit->range_m < gap_m) continue;
    const Vector3d near = place + (hit->range_m - gap_m) * ahead;
    if (rays.clearance_m(near, 1) < clearance_m) continue;
    const Vector3d view = Eigen::AngleAxisd(turn, up) * ahead + pitch * up;
    return {{{near, view}, {near + step_m * view.cross(up).normalized(), view}}, false};
  }
}

/// Adds an offset to all phases of B.
void shift_b(Frame& frame, double cycles) {
  for (float& phase : frame.phases[1].reshaped()) {
    phase += static_cast<float>(cycles);
    phase -= std::floor(phase);
  }
}

/// Adds frames of a recording to a case.
class SampleTaker {
 public:
  SampleTaker(const Recording& recording, Case& example)
      : recording_(recording), example_(example), options_(simulator_options(recording)) {}

  void take_on_path(const Scene& scene, int frames) {
    const Simulator simulator(scene, options_);
    for (int i = 0; i < frames; ++i) {
      take(simulator, (2 * i + 1) * *simulator.frame_count() / (2 * frames));
    }
  }

  void take_near_walls(const Scene& scene, int seed, int frames) {
    const RayScene rays(scene.surface);
    std::mt19937 random(static_cast<unsigned>(seed));
    for (int i = 0; i < frames; ++i) {
      Scene seen = scene;
      seen.path = step_near_wall(scene, rays, random);
      take(Simulator(seen, options_), 0);
    }
  }

 private:
  void take(const Simulator& simulator, int index) {
    if (example_.samples.empty()) {
      example_.sensor = simulator.sensor();
      example_.rays = pixel_rays(example_.sensor.camera);
    }
    Sample sample;
    sample.simulated = simulator.simulate(index);
    const double wavelength_b_m = simulator.sensor().modulation.wavelength_m(1);
    shift_b(sample.simulated.frame, recording_.b_offset_m / wavelength_b_m);
    sample.unwrapped = unwrap(sample.simulated.frame, simulator.sensor(), {}).image;
    example_.samples.push_back(std::move(sample));
  }

  const Recording& recording_;
  Case& example_;
  SimulatorOptions options_;
};

}  // namespace

std::vector<Recording> development_recordings() {
  return {
      {.name = "random rooms", .scene = "random", .seeds = 40, .frames = 1},
      {.name = "random rooms, 1 cm",
       .scene = "random",
       .seeds = 20,
       .frames = 1,
       .range_noise_m = 0.01},
      {.name = "random rooms, 5 cm",
       .scene = "random",
       .seeds = 20,
       .frames = 1,
       .range_noise_m = 0.05},
      {.name = "room", .scene = "room"},
      {.name = "hall", .scene = "hall"},
      {.name = "flat", .scene = "flat"},
      {.name = "corridor", .scene = "corridor"},
      {.name = "atrium", .scene = "atrium"},
      {.name = "atrium, 4 cm", .scene = "atrium", .range_noise_m = 0.04},
      {.name = "hall, 1 cm", .scene = "hall", .range_noise_m = 0.01},
      {.name = "hall, 5 cm", .scene = "hall", .range_noise_m = 0.05},
      {.name = "near walls of hall", .scene = "hall", .frames = 16, .views = Views::near_walls},
      {.name = "near walls of flat", .scene = "flat", .frames = 16, .views = Views::near_walls},
      {.name = "near walls of random rooms",
       .scene = "random",
       .seeds = 16,
       .frames = 1,
       .views = Views::near_walls},
      {.name = "flat, 320 px, 5 x 5 rays",
       .scene = "flat",
       .frames = 4,
       .width_px = 320,
       .subpixels = 5},
      {.name = "room, 88 px, 6 x 6 rays",
       .scene = "room",
       .frames = 16,
       .width_px = 88,
       .subpixels = 6},
      {.name = "flat, B off by 5 cm", .scene = "flat", .b_offset_m = 0.05},
      {.name = "flat, 3 cm of wiggling", .scene = "flat", .wiggle_m = 0.03},
  };
}

std::vector<Recording> frozen_recordings() {
  return {
      {.name = "random rooms, seeds from 900",
       .scene = "random",
       .first_seed = 900,
       .seeds = 40,
       .frames = 1},
      {.name = "random rooms, seeds from 950, 4 cm",
       .scene = "random",
       .first_seed = 950,
       .seeds = 20,
       .frames = 1,
       .range_noise_m = 0.04},
      {.name = "near walls of random rooms, seeds from 980",
       .scene = "random",
       .first_seed = 980,
       .seeds = 20,
       .frames = 1,
       .views = Views::near_walls},
      {.name = "near walls of room",
       .scene = "room",
       .first_seed = 900,
       .frames = 16,
       .views = Views::near_walls},
      {.name = "near walls of atrium, 4 x 4 rays",
       .scene = "atrium",
       .first_seed = 900,
       .frames = 16,
       .views = Views::near_walls,
       .subpixels = 4},
      {.name = "beyond, 3 cm", .scene = "beyond", .range_noise_m = 0.03},
      {.name = "slope, 1 cm", .scene = "slope", .range_noise_m = 0.01},
      {.name = "random rooms, seeds from 1000, B off by 3 cm",
       .scene = "random",
       .first_seed = 1000,
       .seeds = 20,
       .frames = 1,
       .b_offset_m = 0.03},
  };
}

Case make_case(const Recording& recording, int divisor) {
  Case example{recording.name, {}, {}, {}};
  SampleTaker taker(recording, example);
  const bool has_many = recording.seeds > 1;
  const int seeds = has_many ? std::max(1, recording.seeds / divisor) : 1;
  const int frames = has_many ? recording.frames : std::max(1, recording.frames / divisor);
  for (int seed = recording.first_seed; seed < recording.first_seed + seeds; ++seed) {
    const Scene scene = find_scene(recording.scene, seed);
    if (recording.views == Views::path) {
      taker.take_on_path(scene, frames);
    } else {
      taker.take_near_walls(scene, seed, frames);
    }
  }
  return example;
}

}  // namespace tofmap::bench

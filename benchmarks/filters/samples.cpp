// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "samples.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/simulation/pixel_label.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::bench {
namespace {

Sample take_sample(const Simulator& simulator, int index, Unwrapper& unwrapper) {
  Sample sample;
  sample.simulated = simulator.simulate(index);
  sample.unwrapped = unwrapper.unwrap(sample.simulated.frame).image;
  return sample;
}

/// Adds frames from the middles of equal parts of the path of a scene.
void add_samples(const std::string& scene, int scene_seed, const std::string& method, int frames,
                 Case& example) {
  const Simulator simulator(make_scene(scene, scene_seed), {});
  example.sensor = simulator.sensor();
  example.rays = pixel_rays(example.sensor.camera);
  UnwrapOptions options;
  options.method = find_named<UnwrapMethod>(method).value();
  Unwrapper unwrapper(example.sensor, options);
  for (int i = 0; i < frames; ++i) {
    const int index = (2 * i + 1) * *simulator.frame_count() / (2 * frames);
    example.samples.push_back(take_sample(simulator, index, unwrapper));
  }
}

}  // namespace

std::vector<Case> make_cases(const std::string& method, int divisor) {
  std::vector<Case> cases;
  Case rooms{"random rooms", {}, {}, {}};
  for (int seed = 1; seed <= std::max(1, 24 / divisor); ++seed) {
    add_samples("random", seed, method, 2, rooms);
  }
  cases.push_back(std::move(rooms));
  for (const char* scene : {"room", "hall", "flat", "corridor"}) {
    Case example{scene, {}, {}, {}};
    add_samples(scene, 1, method, std::max(1, 16 / divisor), example);
    cases.push_back(std::move(example));
  }
  return cases;
}

Case make_run(const std::string& scene, int frames) {
  const Simulator simulator(make_scene(scene, 1), {});
  Case run{scene, simulator.sensor(), pixel_rays(simulator.sensor().camera), {}};
  Unwrapper unwrapper(run.sensor, {});
  const int first = *simulator.frame_count() / 2;
  for (int i = 0; i < frames; ++i) {
    run.samples.push_back(take_sample(simulator, first + i, unwrapper));
  }
  return run;
}

bool sees_several_surfaces(const Sample& sample, Eigen::Index row, Eigen::Index col) {
  const auto label = static_cast<PixelLabel>(sample.simulated.label(row, col));
  return label == PixelLabel::mixed || label == PixelLabel::flying;
}

bool is_labelled_flying(const Sample& sample, Eigen::Index row, Eigen::Index col) {
  return static_cast<PixelLabel>(sample.simulated.label(row, col)) == PixelLabel::flying;
}

bool is_flying(const Sample& sample, Eigen::Index row, Eigen::Index col) {
  constexpr float tolerance_m = 0.05F;
  constexpr float sigmas = 3;
  if (!sees_several_surfaces(sample, row, col)) return false;
  const ImageF& truth_m = sample.simulated.range_truth_m;
  const RangeImage& image = sample.unwrapped;
  const float tolerated_m = std::max(tolerance_m, sigmas * image.sigma_m(row, col));
  const Eigen::Index last_row = std::min(image.rows() - 1, row + 1);
  const Eigen::Index last_col = std::min(image.cols() - 1, col + 1);
  for (Eigen::Index r = std::max<Eigen::Index>(0, row - 1); r <= last_row; ++r) {
    for (Eigen::Index c = std::max<Eigen::Index>(0, col - 1); c <= last_col; ++c) {
      if (std::abs(truth_m(r, c) - image.range_m(row, col)) < tolerated_m) return false;
    }
  }
  return true;
}

}  // namespace tofmap::bench

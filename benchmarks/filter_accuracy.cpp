// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// What filters remove and what they lose, as tables in Markdown:
//
//     bench_filter_accuracy [--divide N]
//
// The recordings are simulated, so that it is known which pixels fly. N divides the number of
// frames.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <tofmap/acquisition/pixel_label.hpp>
#include <tofmap/acquisition/simulator.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {
namespace {

/// A simulated frame, unwrapped.
struct Sample {
  SimulatedFrame simulated;
  RangeImage unwrapped;
};

struct Case {
  std::string name;
  Modulation modulation;
  PixelRays rays;
  std::vector<Sample> samples;
};

struct Filter {
  std::string name;
  std::function<RangeImage(const Case&, const Sample&)> apply;
};

struct Share {
  double part = 0;
  double all = 0;

  void add(bool is_part) {
    part += is_part ? 1 : 0;
    all += 1;
  }
  /// A dash if there is nothing to share.
  std::string percent(int digits) const {
    if (all == 0) return "–";
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, 100 * part / all);
    return text;
  }
};

double median(std::vector<float>& values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Incidence angles up to which good pixels are counted together, degrees.
constexpr std::array<double, 4> angles_deg{60, 70, 80, 90};

/// What a filter did with all frames of a case.
struct Score {
  Share found;    ///< of the flying pixels: removed
  Share precise;  ///< of the removed pixels: flying or mixed
  Share lost;     ///< of the right pixels: removed
  Share lost_far;
  std::array<Share, angles_deg.size()> lost_by_angle;
  // Of pixels that are kept and see one surface, right or noisy:
  double squared_before_m2 = 0;
  double squared_after_m2 = 0;
  double one_surface_kept = 0;
  std::vector<float> before_m;
  std::vector<float> after_m;
  double milliseconds = 0;

  double rmse_m() const { return std::sqrt(squared_after_m2 / one_surface_kept); }
  double noise_share() const { return std::sqrt(squared_after_m2 / squared_before_m2); }
  double median_share() { return median(after_m) / median(before_m); }
};

bool sees_several_surfaces(const SimulatedFrame& truth, Eigen::Index v, Eigen::Index u) {
  const auto label = static_cast<PixelLabel>(truth.label(v, u));
  return label == PixelLabel::mixed || label == PixelLabel::flying;
}

/// A mixed pixel flies if its range is none of the surfaces around it, by more than 5 cm and three
/// standard deviations of its noise. (The label itself is of A's range alone.)
bool is_flying(const Sample& sample, Eigen::Index v, Eigen::Index u) {
  constexpr float tolerance_m = 0.05F;
  constexpr float sigmas = 3;
  const SimulatedFrame& truth = sample.simulated;
  const RangeImage& image = sample.unwrapped;
  if (!sees_several_surfaces(truth, v, u)) return false;
  const float tolerated_m = std::max(tolerance_m, sigmas * image.sigma_m(v, u));
  for (Eigen::Index r = std::max<Eigen::Index>(0, v - 1); r <= std::min(image.rows() - 1, v + 1);
       ++r) {
    for (Eigen::Index c = std::max<Eigen::Index>(0, u - 1); c <= std::min(image.cols() - 1, u + 1);
         ++c) {
      if (std::abs(truth.range_truth_m(r, c) - image.range_m(v, u)) < tolerated_m) return false;
    }
  }
  return true;
}

void tally(const Sample& sample, const RangeImage& kept, Score& score) {
  constexpr float far_m = 5;
  constexpr double wrong_m = 2;  // a wrong wrap
  const SimulatedFrame& truth = sample.simulated;
  for (Eigen::Index v = 0; v < kept.rows(); ++v) {
    for (Eigen::Index u = 0; u < kept.cols(); ++u) {
      if (!sample.unwrapped.valid(v, u)) continue;
      const bool is_removed = !kept.valid(v, u);
      if (is_flying(sample, v, u)) score.found.add(is_removed);
      if (is_removed) score.precise.add(sees_several_surfaces(truth, v, u));
      const auto label = static_cast<PixelLabel>(truth.label(v, u));
      const bool sees_one_surface = label == PixelLabel::right || label == PixelLabel::noisy;
      if (!sees_one_surface || std::isnan(truth.range_truth_m(v, u))) continue;
      const double error_m = sample.unwrapped.range_m(v, u) - truth.range_truth_m(v, u);
      if (std::abs(error_m) > wrong_m) continue;
      if (!is_removed) {
        const double kept_error_m = kept.range_m(v, u) - truth.range_truth_m(v, u);
        score.squared_before_m2 += error_m * error_m;
        score.squared_after_m2 += kept_error_m * kept_error_m;
        score.one_surface_kept += 1;
        score.before_m.push_back(static_cast<float>(std::abs(error_m)));
        score.after_m.push_back(static_cast<float>(std::abs(kept_error_m)));
      }
      if (label == PixelLabel::noisy) continue;
      score.lost.add(is_removed);
      if (truth.range_truth_m(v, u) > far_m) score.lost_far.add(is_removed);
      const double angle_deg = std::acos(truth.cos_incidence(v, u)) * 180 / std::numbers::pi;
      const auto bin = std::ranges::upper_bound(angles_deg, angle_deg) - angles_deg.begin();
      score.lost_by_angle[static_cast<std::size_t>(bin)].add(is_removed);
    }
  }
}

Score score_filter(const Filter& filter, const Case& example) {
  Score score;
  for (const Sample& sample : example.samples) {
    const auto start = std::chrono::steady_clock::now();
    const RangeImage kept = filter.apply(example, sample);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    score.milliseconds += time.count() / static_cast<double>(example.samples.size());
    tally(sample, kept, score);
  }
  return score;
}

void add_samples(const std::string& scene, int scene_seed, const SimulatorOptions& options,
                 int frames, Case& example) {
  const Simulator simulator(make_scene(scene, scene_seed), options);
  example.modulation = simulator.sensor().modulation;
  example.rays = pixel_rays(simulator.sensor().camera);
  Unwrapper unwrapper(simulator.sensor(), {});
  for (int i = 0; i < frames; ++i) {
    Sample sample{simulator.simulate((2 * i + 1) * *simulator.frame_count() / (2 * frames)), {}};
    sample.unwrapped = unwrapper.unwrap(sample.simulated.frame).image;
    example.samples.push_back(std::move(sample));
  }
}

std::vector<Case> make_cases(int divisor) {
  std::vector<Case> cases;
  SimulatorOptions options;
  Case rooms{"random rooms", {}, {}, {}};
  for (int seed = 1; seed <= std::max(1, 24 / divisor); ++seed) {
    add_samples("random", seed, options, 2, rooms);
  }
  cases.push_back(std::move(rooms));
  for (const char* scene : {"room", "hall", "flat", "corridor"}) {
    Case example{scene, {}, {}, {}};
    add_samples(scene, 1, options, std::max(1, 16 / divisor), example);
    cases.push_back(std::move(example));
  }
  return cases;
}

Filter chain(const std::string& name, const FilterOptions& options) {
  return {name, [options](const Case& example, const Sample& sample) {
            return apply_filters(sample.unwrapped, sample.simulated.frame, example.modulation,
                                 example.rays, options)
                .image;
          }};
}

std::vector<Filter> filters() {
  std::vector<Filter> all;
  FilterOptions options;
  options.chain = "";
  all.push_back(chain("none", options));
  FilterOptions as_published;
  as_published.chain = "jump_edge";
  as_published.min_edge_gap_sigmas = 0;
  all.push_back(chain("jump_edge, as published", as_published));
  for (const char* name :
       {"jump_edge", "step_edge", "plane_edge", "outlier", "smooth", "plane_edge smooth"}) {
    options.chain = name;
    all.push_back(chain(name, options));
  }
  return all;
}

void print_scores(const Case& example) {
  std::printf("\n| %s | flying found, %% | removed are mixed, %% | right lost, %% | beyond 5 m |",
              example.name.c_str());
  for (const double angle_deg : angles_deg) std::printf(" to %.0f° |", angle_deg);
  std::printf(" RMSE, cm | over that before | median | ms |\n|---|---|---|---|---|");
  for (std::size_t bin = 0; bin < angles_deg.size(); ++bin) std::printf("---|");
  std::printf("---|---|---|---|\n");
  for (const Filter& filter : filters()) {
    Score score = score_filter(filter, example);
    std::printf("| %s | %s | %s | %s | %s |", filter.name.c_str(), score.found.percent(1).c_str(),
                score.precise.percent(1).c_str(), score.lost.percent(2).c_str(),
                score.lost_far.percent(2).c_str());
    for (const Share& share : score.lost_by_angle) std::printf(" %s |", share.percent(2).c_str());
    std::printf(" %.2f | %.2f | %.2f | %.2f |\n", 100 * score.rmse_m(), score.noise_share(),
                score.median_share(), score.milliseconds);
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace tofmap

int main(int count, char** arguments) {
  int divisor = 1;
  for (int i = 1; i + 1 < count; ++i) {
    if (std::strcmp(arguments[i], "--divide") == 0)
      divisor = std::max(1, std::atoi(arguments[i + 1]));
  }
  for (const tofmap::Case& example : tofmap::make_cases(divisor)) tofmap::print_scores(example);
  return 0;
}

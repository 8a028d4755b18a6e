// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Wrong wraps and time per frame of the methods of others, on synthetic scenes under several
// noises.

#include "peers/kde_unwrap.hpp"
#include "peers/libfreenect2_unwrap.hpp"
#include "peers/synthetic_scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <malloc.h>

namespace tofmap::peers {
namespace {

constexpr int width_px = 512;
constexpr int height_px = 424;

/// A range farther from the truth has a wrong wrap: a count of 120 MHz that is wrong by one moves
/// the fused range by 0.69 m.
constexpr float wrong_m = 0.3F;

struct Method {
  std::string name;
  std::function<ImageF(const ThreePhases&)> unwrap;
};

Method kde(const std::string& name, const KdeOptions& options) {
  return {name, [=](const ThreePhases& phases) { return kde_unwrap(phases, options).range_m; }};
}

Method libfreenect2(const std::string& name, const Libfreenect2Options& options) {
  return {name,
          [=](const ThreePhases& phases) { return libfreenect2_unwrap(phases, options).range_m; }};
}

/// Each method with and without smoothing, and with and without the rejection of outliers.
std::vector<Method> all_methods() {
  std::vector<Method> methods;
  for (const bool smooth : {true, false}) {
    for (const bool reject : {false, true}) {
      const std::string suffix =
          fmt::format("{}{}", smooth ? ", smoothed" : "", reject ? ", rejecting" : "");
      for (const int hypotheses : {2, 3}) {
        KdeOptions options;
        options.smooth = smooth;
        options.hypotheses = hypotheses;
        options.min_confidence = reject ? options.min_confidence : 0;
        methods.push_back(kde(fmt::format("KDE-{}{}", hypotheses, suffix), options));
      }
      Libfreenect2Options options;
      options.smooth = smooth;
      options.reject_outliers = reject;
      methods.push_back(libfreenect2("libfreenect2" + suffix, options));
    }
  }
  return methods;
}

struct Score {
  double wrong_percent;  ///< of the pixels with a range
  double kept_percent;
  double right_percent;  ///< of all pixels
};

Score score(const ImageF& range_m, const ImageF& truth_m) {
  const auto kept = static_cast<double>((!range_m.isNaN()).count());
  const auto right = static_cast<double>(((range_m - truth_m).abs() <= wrong_m).count());
  const auto all = static_cast<double>(range_m.size());
  return {kept > 0 ? 100 * (kept - right) / kept : 0, 100 * kept / all, 100 * right / all};
}

void print_scores(const std::vector<Method>& methods) {
  struct Condition {
    double sigma_rad;
    double bias_16_m;
  };
  constexpr std::array<Condition, 7> conditions{
      {{0.05, 0}, {0.1, 0}, {0.2, 0}, {0.4, 0}, {0.8, 0}, {0.1, 0.09}, {0.2, 0.09}}};
  for (const SyntheticScene scene : all_synthetic_scenes) {
    const SceneView view = view_of(scene, width_px, height_px);
    for (const auto& [sigma_rad, bias_16_m] : conditions) {
      NoiseOptions noise;
      noise.sigma_at_10_m_rad = sigma_rad;
      noise.range_bias_m = {0, bias_16_m, 0};
      const ThreePhases phases = measure(view, noise);
      fmt::print("\n{}, phase noise {} rad at 10 m, 16 MHz longer by {} m\n", name_of(scene),
                 sigma_rad, bias_16_m);
      fmt::print("{:<36}{:>9}{:>9}{:>9}\n", "", "wrong %", "kept %", "right %");
      for (const Method& method : methods) {
        const Score s = score(method.unwrap(phases), view.range_m);
        fmt::print("{:<36}{:>9.3f}{:>9.2f}{:>9.2f}\n", method.name, s.wrong_percent, s.kept_percent,
                   s.right_percent);
      }
    }
  }
}

/// Wrong wraps of the pixels of hall and corridor by the standard deviation of their phase at 80
/// MHz.
void print_scores_by_sigma(const std::vector<Method>& methods) {
  constexpr std::array limits_rad{0.0, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.2};
  constexpr std::size_t bins = limits_rad.size() - 1;
  const auto bin_of = [&](double sigma_rad) {
    return static_cast<std::size_t>(
        std::upper_bound(limits_rad.begin(), limits_rad.end(), sigma_rad) - limits_rad.begin() - 1);
  };
  fmt::print("\nwrong and missing ranges in percent by phase noise at 80 MHz (rad)\n{:<36}", "");
  for (std::size_t b = 0; b < bins; ++b)
    fmt::print("{:>15}", fmt::format("{} to {}", limits_rad[b], limits_rad[b + 1]));
  fmt::print("\n");
  for (const Method& method : methods) {
    std::array<std::array<double, 3>, bins> counts{};  // all, wrong, missing
    for (const SyntheticScene scene : {SyntheticScene::hall, SyntheticScene::corridor}) {
      const SceneView view = view_of(scene, width_px, height_px);
      for (const double at_10_m_rad : {0.1, 0.2, 0.4}) {
        NoiseOptions noise;
        noise.sigma_at_10_m_rad = at_10_m_rad;
        const ImageF range_m = method.unwrap(measure(view, noise));
        for (Eigen::Index i = 0; i < range_m.size(); ++i) {
          const double truth_m = view.range_m.data()[i];
          const double sigma_rad =
              at_10_m_rad * truth_m * truth_m / 100 * 0.5 / view.albedo.data()[i];
          const std::size_t bin = bin_of(sigma_rad);
          if (bin >= bins) continue;
          const float error_m = std::abs(range_m.data()[i] - view.range_m.data()[i]);
          counts[bin][0] += 1;
          counts[bin][1] += error_m > wrong_m ? 1 : 0;
          counts[bin][2] += std::isnan(error_m) ? 1 : 0;
        }
      }
    }
    fmt::print("{:<36}", method.name);
    for (const auto& [all, wrong, missing] : counts)
      fmt::print("{:>15}", fmt::format("{:.3f}, {:.1f}", 100 * wrong / all, 100 * missing / all));
    fmt::print("\n");
  }
}

/// The least of several processor times, which other programs disturb less than elapsed times.
double milliseconds(const Method& method, const ThreePhases& phases) {
  double least_ms = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 15; ++i) {
    const std::clock_t start = std::clock();
    const ImageF range_m = method.unwrap(phases);
    const double time_ms = 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    if (range_m.size() > 0) least_ms = std::min(least_ms, time_ms);
  }
  return least_ms;
}

void print_times(const std::vector<Method>& methods) {
  NoiseOptions noise;
  noise.sigma_at_10_m_rad = 0.2;
  const ThreePhases phases = measure(view_of(SyntheticScene::hall, width_px, height_px), noise);
  fmt::print("\nmilliseconds per frame of {} × {} pixels on one core\n", width_px, height_px);
  for (const Method& method : methods)
    fmt::print("{:<36}{:>9.1f}\n", method.name, milliseconds(method, phases));
}

}  // namespace
}  // namespace tofmap::peers

int main(int count, char** arguments) {
  // Memory is kept from frame to frame, as a program with buffers of its own would keep it.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  const std::vector<tofmap::peers::Method> methods = tofmap::peers::all_methods();
  const bool times_alone = count > 1 && std::string_view(arguments[1]) == "--times";
  if (!times_alone) {
    tofmap::peers::print_scores(methods);
    tofmap::peers::print_scores_by_sigma(methods);
  }
  tofmap::peers::print_times(methods);
  return 0;
}

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Wrong wraps and time per frame of the methods of others, on synthetic scenes under several
// noises.

#include "peers/kde_unwrap.hpp"
#include "peers/libfreenect2_unwrap.hpp"
#include "peers/synthetic_scenes.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

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
  constexpr std::array sigmas_rad{0.05, 0.1, 0.2, 0.4, 0.8};
  for (const SyntheticScene scene : all_synthetic_scenes) {
    const SceneView view = view_of(scene, width_px, height_px);
    for (const double sigma_rad : sigmas_rad) {
      NoiseOptions noise;
      noise.sigma_at_10_m_rad = sigma_rad;
      const ThreePhases phases = measure(view, noise);
      fmt::print("\n{}, phase noise {} rad at 10 m\n", name_of(scene), sigma_rad);
      fmt::print("{:<36}{:>9}{:>9}{:>9}\n", "", "wrong %", "kept %", "right %");
      for (const Method& method : methods) {
        const Score s = score(method.unwrap(phases), view.range_m);
        fmt::print("{:<36}{:>9.3f}{:>9.2f}{:>9.2f}\n", method.name, s.wrong_percent, s.kept_percent,
                   s.right_percent);
      }
    }
  }
}

/// The shortest of several times, which other programs of the machine disturb least.
double milliseconds(const Method& method, const ThreePhases& phases) {
  double least_ms = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 15; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const ImageF range_m = method.unwrap(phases);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    if (range_m.size() > 0) least_ms = std::min(least_ms, time.count());
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
  const std::vector<tofmap::peers::Method> methods = tofmap::peers::all_methods();
  const bool times_alone = count > 1 && std::string_view(arguments[1]) == "--times";
  if (!times_alone) tofmap::peers::print_scores(methods);
  tofmap::peers::print_times(methods);
  return 0;
}

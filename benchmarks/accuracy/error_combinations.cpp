// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "error_combinations.hpp"

#include "text.hpp"

#include <array>
#include <functional>
#include <random>

#include <fmt/format.h>

namespace tofmap::accuracy {
namespace {

constexpr std::array<double, 4> noises_m{0.005, 0.02, 0.05, 0.1};
constexpr std::array<double, 4> delays{0, 0.1, 0.5, 1};

/// A kind of error, its sizes, and the function that sets it.
struct Kind {
  const char* name;
  const char* unit;
  double unit_scale;          ///< factor from sizes to printed sizes
  std::vector<double> sizes;  ///< the last one is the largest
  std::function<void(CameraErrors&, double)> set;

  std::string text(double size) const { return fmt::format("{:g}{}", size * unit_scale, unit); }
};

/// All kinds of error. Both frequencies have a periodic error of the same size, but of different
/// shape. Only B has an error with amplitude, since an equal error of both frequencies does not
/// change wrap counts.
std::vector<Kind> kinds() {
  return {
      {"offset", " cm", 100, {-0.1, -0.05, 0.05, 0.1}, [](auto& e, double m) { e.offset_m = m; }},
      {"periodic",
       " cm",
       100,
       {0.01, 0.03, 0.05},
       [](auto& e, double m) { e.periodic_a_m = e.periodic_b_m = m; }},
      {"amplitude",
       " cm",
       100,
       {0.015, 0.03},
       [](auto& e, double m) { e.amplitude_error_b_m = m; }},
      {"pattern", " cm", 100, {0.005, 0.01}, [](auto& e, double m) { e.pattern_m = m; }},
      {"delay", " frames", 1, {0.1, 0.5, 1}, [](auto& e, double share) { e.delay_share = share; }},
      {"ambient", "x", 1, {2, 5}, [](auto& e, double factor) { e.ambient_noise = factor; }},
      {"noise",
       " cm",
       100,
       {noises_m.begin(), noises_m.end()},
       [](auto& e, double m) { e.noise_m = m; }},
  };
}

void add_single_errors(std::vector<Combination>& out) {
  for (const Kind& kind : kinds()) {
    for (const double size : kind.sizes) {
      Combination added{kind.name, kind.text(size), {}};
      kind.set(added.errors, size);
      out.push_back(added);
    }
  }
}

void add_pairs(std::vector<Combination>& out) {
  const std::vector<Kind> all = kinds();
  for (std::size_t one = 0; one < all.size(); ++one) {
    for (std::size_t other = one + 1; other < all.size(); ++other) {
      Combination added{
          "two errors",
          fmt::format("{} {}, {} {}", all[one].name, all[one].text(all[one].sizes.back()).c_str(),
                      all[other].name, all[other].text(all[other].sizes.back()).c_str()),
          {}};
      all[one].set(added.errors, all[one].sizes.back());
      all[other].set(added.errors, all[other].sizes.back());
      out.push_back(added);
    }
  }
}

/// Random numbers that are the same with every standard library.
class Draw {
 public:
  explicit Draw(int seed) : random_(static_cast<std::uint32_t>(seed)) {}

  double between(double low, double high) { return low + (high - low) * share(); }

  double one_of(const std::array<double, 4>& values) {
    return values[static_cast<std::size_t>(share() * 4)];
  }

 private:
  double share() { return static_cast<double>(random_()) / 4294967296.0; }

  std::mt19937 random_;
};

/// A random combination of all errors. Half of the cameras see ambient light, in 9 to 40 % of the
/// image.
CameraErrors drawn_errors(Draw& draw) {
  CameraErrors errors;
  errors.offset_m = draw.between(-0.1, 0.1);
  errors.periodic_a_m = draw.between(0, 0.05);
  errors.periodic_b_m = draw.between(0, 0.05);
  errors.amplitude_error_a_m = draw.between(-0.03, 0.03);
  errors.amplitude_error_b_m = draw.between(-0.03, 0.03);
  errors.pattern_m = draw.between(0, 0.01);
  errors.delay_share = draw.one_of(delays);
  errors.noise_m = draw.one_of(noises_m);
  const bool in_the_sun = draw.between(0, 1) < 0.5;
  const double factor = draw.between(1.5, 5);
  errors.ambient_left = draw.between(0, 0.5);
  errors.ambient_right = errors.ambient_left + draw.between(0.3, 0.5);
  errors.ambient_top = draw.between(0, 0.2);
  errors.ambient_bottom = errors.ambient_top + draw.between(0.3, 0.8);
  if (in_the_sun) errors.ambient_noise = factor;
  return errors;
}

}  // namespace

bool CameraErrors::are_none() const {
  return offset_m == 0 && periodic_a_m == 0 && periodic_b_m == 0 && amplitude_error_a_m == 0 &&
         amplitude_error_b_m == 0 && pattern_m == 0 && delay_share == 0 && !has_ambient();
}

SimulatorOptions with_errors(SimulatorOptions base, const CameraErrors& errors) {
  base.offset_b_m = errors.offset_m;
  base.periodic_a_m = errors.periodic_a_m;
  base.periodic_b_m = errors.periodic_b_m;
  base.amplitude_error_a_m = errors.amplitude_error_a_m;
  base.amplitude_error_b_m = errors.amplitude_error_b_m;
  base.fixed_pattern_m = errors.pattern_m;
  base.b_delay_share = errors.delay_share;
  base.ambient_noise = errors.ambient_noise;
  base.ambient_left = errors.ambient_left;
  base.ambient_top = errors.ambient_top;
  base.ambient_right = errors.ambient_right;
  base.ambient_bottom = errors.ambient_bottom;
  base.range_noise_m = errors.noise_m;
  return base;
}

std::vector<Combination> error_combinations(const GridPlan& plan) {
  std::vector<Combination> out;
  add_single_errors(out);
  if (plan.with_pairs) add_pairs(out);
  Draw draw(plan.seed);
  for (int i = 0; i < plan.drawn; ++i) {
    const CameraErrors errors = drawn_errors(draw);
    const char* sun = errors.has_ambient() ? "drawn, ambient light" : "drawn";
    out.push_back({sun, fmt::format("no. {}", i + 1), errors});
  }
  return out;
}

}  // namespace tofmap::accuracy

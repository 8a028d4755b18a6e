// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "walk_planner.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double easy_speed_m_per_s = 1.5;
constexpr double max_speed_m_per_s = 3;
constexpr double absence_cost_per_s = 60;
constexpr double leaving_cost = 30;  ///< also of coming back

/// The states of one time: the places and, last, absence.
struct Stage {
  std::vector<WalkPlace> places;
  std::vector<double> cost;         ///< of the cheapest walk that ends there
  std::vector<std::size_t> before;  ///< the state before on that walk

  std::size_t size() const { return places.size() + 1; }
  bool is_absence(std::size_t state) const { return state == places.size(); }
};

double cost_of_step(const Stage& from, std::size_t i, const Stage& to, std::size_t j,
                    double step_s) {
  if (from.is_absence(i) || to.is_absence(j)) {
    return from.is_absence(i) == to.is_absence(j) ? 0 : leaving_cost;
  }
  const double speed = (to.places[j].foot_m - from.places[i].foot_m).norm() / step_s;
  if (speed > max_speed_m_per_s) return infinity;
  return step_s * speed * speed / (easy_speed_m_per_s * easy_speed_m_per_s);
}

Stage next_stage(const Stage& last, std::vector<WalkPlace> places, double step_s) {
  Stage stage{std::move(places), {}, {}};
  for (std::size_t j = 0; j < stage.size(); ++j) {
    double best = infinity;
    std::size_t best_before = 0;
    for (std::size_t i = 0; i < last.size(); ++i) {
      if (last.cost[i] >= best) continue;
      const double cost = last.cost[i] + cost_of_step(last, i, stage, j, step_s);
      if (cost >= best) continue;
      best = cost;
      best_before = i;
    }
    const double stay = stage.is_absence(j) ? absence_cost_per_s : stage.places[j].cost_per_s;
    stage.cost.push_back(best + step_s * stay);
    stage.before.push_back(best_before);
  }
  return stage;
}

}  // namespace

double cost_of_offset(double off_m) {
  constexpr double near_m = 0.2;
  return 2 * (std::hypot(1, off_m / near_m) - 1);
}

WalkedPlaces cheapest_walk(int steps, double step_s,
                           const std::function<std::vector<WalkPlace>(int step)>& places) {
  std::vector<Stage> stages;
  stages.push_back({{}, {0}, {0}});  // before the first time, everyone is outside at no cost
  for (int i = 0; i < steps; ++i) {
    stages.push_back(next_stage(stages.back(), places(i), step_s));
    if (i > 0) continue;
    for (std::size_t j = 0; j + 1 < stages[1].size(); ++j) stages[1].cost[j] -= leaving_cost;
  }
  WalkedPlaces walk(static_cast<std::size_t>(steps));
  std::size_t state = 0;
  for (std::size_t j = 1; j < stages.back().size(); ++j) {
    if (stages.back().cost[j] < stages.back().cost[state]) state = j;
  }
  for (std::size_t i = stages.size() - 1; i > 0; --i) {
    if (!stages[i].is_absence(state)) walk[i - 1] = stages[i].places[state].foot_m;
    state = stages[i].before[state];
  }
  return walk;
}

void smooth_walk(WalkedPlaces& walk,
                 const std::function<bool(int step, const Vector3d& foot_m)>& is_allowed) {
  // Places come to be means over some 0.4 s on each side.
  constexpr int rounds = 30;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 1; i + 1 < walk.size(); ++i) {
      if (!walk[i - 1] || !walk[i] || !walk[i + 1]) continue;
      const Vector3d middle = (*walk[i - 1] + *walk[i + 1]) / 2;
      const Vector3d moved = (*walk[i] + middle) / 2;
      if (is_allowed(static_cast<int>(i), moved)) walk[i] = moved;
    }
  }
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "walker.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double max_turn_rad_per_s = 4;
constexpr double least_speed_m_per_s = 0.2;  ///< below, a person does not turn
constexpr double brisk_speed_m_per_s = 1.0;  ///< from here on, steps have their full length

/// The velocity at one of evenly spaced times. Zero next to a time without a place.
Vector3d velocity_at(const WalkedPlaces& walk, std::size_t i, double step_s) {
  const std::size_t before = i > 0 ? i - 1 : i;
  const std::size_t after = std::min(i + 1, walk.size() - 1);
  if (before == after || !walk[before] || !walk[after]) return Vector3d::Zero();
  return (*walk[after] - *walk[before]) / (static_cast<double>(after - before) * step_s);
}

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

}  // namespace

Walker::Walker(const PersonLook& look, const WalkedPlaces& walk, double start_s, double step_s)
    : look_(look), start_s_(start_s), step_s_(step_s) {
  std::optional<double> heading_rad;
  double gait_rad = 0;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const Vector3d velocity = velocity_at(walk, i, step_s);
    velocities_.push_back(velocity);
    stances_.emplace_back();
    if (!walk[i]) continue;
    const double speed = velocity.head<2>().norm();
    if (speed > least_speed_m_per_s) {
      const double wanted_rad = std::atan2(velocity.y(), velocity.x());
      const double limit_rad = max_turn_rad_per_s * step_s;
      const double last_rad = heading_rad.value_or(wanted_rad);
      heading_rad = last_rad + std::clamp(wrapped(wanted_rad - last_rad), -limit_rad, limit_rad);
    }
    gait_rad += 2 * std::numbers::pi * speed * step_s / stride_m(look);
    stances_.back() = {.foot_m = *walk[i],
                       .heading_rad = heading_rad.value_or(0),
                       .gait_rad = gait_rad,
                       .swing_rad = max_swing_rad * std::min(1.0, speed / brisk_speed_m_per_s)};
  }
}

std::optional<PersonStance> Walker::stance_at(double time_s) const {
  const double last = static_cast<double>(stances_.size() - 1);
  const double place = std::clamp((time_s - start_s_) / step_s_, 0.0, last);
  const auto i = static_cast<std::size_t>(place);
  const std::size_t next = std::min(i + 1, stances_.size() - 1);
  if (!stances_[i] || !stances_[next]) return std::nullopt;
  const PersonStance& a = *stances_[i];
  const PersonStance& b = *stances_[next];
  const double t = place - static_cast<double>(i);
  // Cubic Hermite interpolation, so that the velocity does not jump.
  const double s = 1 - t;
  PersonStance stance;
  stance.foot_m = s * s * (1 + 2 * t) * a.foot_m + t * t * (1 + 2 * s) * b.foot_m +
                  step_s_ * s * t * (s * velocities_[i] - t * velocities_[next]);
  stance.heading_rad = s * a.heading_rad + t * b.heading_rad;
  stance.gait_rad = s * a.gait_rad + t * b.gait_rad;
  stance.swing_rad = s * a.swing_rad + t * b.swing_rad;
  return stance;
}

}  // namespace tofmap

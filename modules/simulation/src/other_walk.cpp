// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "random_draw.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include <tofmap/simulation/ray_scene.hpp>
#include <tofmap/simulation/rearrangement.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;

/// A smooth random function of the place along a path, of about the size 1. Its period is the
/// length of the path.
class SmoothDeviation {
 public:
  explicit SmoothDeviation(RandomDraw& draw, double length_m) {
    constexpr double shortest_wave_m = 4;
    const int most_waves = std::clamp(static_cast<int>(length_m / shortest_wave_m), 1, 5);
    mean_ = (draw.index(2) == 0 ? -1 : 1) * draw.between(0.4, 0.8);
    waves_ = 1 + draw.index(most_waves);
    size_ = draw.between(0.4, 0.7);
    phase_rad_ = draw.between(0, 2 * pi);
  }

  /// `share` of the path, 0 … 1.
  double operator()(double share) const {
    return mean_ + size_ * std::sin(2 * pi * waves_ * share + phase_rad_);
  }

 private:
  double mean_;
  int waves_;
  double size_;
  double phase_rad_;
};

/// Lengths of a path through waypoints, metres.
struct WaypointPlaces {
  std::vector<double> along_m;  ///< from the first waypoint to each
  double length_m = 0;

  explicit WaypointPlaces(const CameraPath& path) {
    const std::vector<Waypoint>& waypoints = path.waypoints();
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      if (i > 0) length_m += (waypoints[i].position_m - waypoints[i - 1].position_m).norm();
      along_m.push_back(length_m);
    }
    if (path.closed()) {
      length_m += (waypoints.front().position_m - waypoints.back().position_m).norm();
    }
  }

  /// The distance between two waypoints along the path.
  double between_m(std::size_t i, std::size_t j, bool closed) const {
    const double way_m = std::abs(along_m[i] - along_m[j]);
    return closed ? std::min(way_m, length_m - way_m) : way_m;
  }
};

/// The scene's path at spline parameters about 3 cm apart, and how near the surface comes there.
struct PathSample {
  double u = 0;
  Pose pose;
  double clearance_m = 0;
};

std::vector<PathSample> samples_of(const CameraPath& path, const RayScene& rays, double limit_m) {
  constexpr double spacing_m = 0.03;
  constexpr int per_segment = 50;
  std::vector<PathSample> samples;
  const int count = static_cast<int>(path.end()) * per_segment;
  for (int i = 0; i <= count; ++i) {
    const double u = path.end() * i / count;
    const Pose pose = path.pose_at(u);
    // Waypoints of meshes are close together, so that most of these samples are not needed.
    if (!samples.empty() && i % per_segment != 0 && i != count &&
        (pose.translation() - samples.back().pose.translation()).norm() < spacing_m) {
      continue;
    }
    samples.push_back({u, pose, rays.clearance_m(pose.translation(), limit_m)});
  }
  return samples;
}

/// Finds a walk that deviates from the path of a scene.
class WalkSearch {
 public:
  WalkSearch(const Scene& scene, int seed)
      : path_(scene.path),
        rays_(scene.surface),
        places_(path_),
        samples_(samples_of(path_, rays_, clearance_m)),
        draw_(seed, 0x77616c6bULL) {}

  CameraPath found() {
    constexpr int attempts = 12;
    CameraPath best = path_;
    double best_deviation = -1;
    for (int i = 0; i < attempts && best_deviation < 1; ++i) {
      CameraPath walk = drawn_walk();
      const double deviation = deviation_of(walk);
      if (deviation <= best_deviation) continue;
      best_deviation = deviation;
      best = std::move(walk);
    }
    return begun_elsewhere(best);
  }

 private:
  static constexpr double clearance_m = 0.32;  ///< 0.3 m and some for places between samples

  /// What is added to each waypoint.
  struct Deviations {
    std::vector<Vector3d> offset_m;
    std::vector<double> yaw_rad;
    std::vector<double> pitch_rad;
  };

  Deviations drawn_deviations() {
    constexpr double sideways_m = 0.55;
    constexpr double upwards_m = 0.12;
    constexpr double yaw_rad = 0.3;
    constexpr double pitch_rad = 0.05;
    const SmoothDeviation x(draw_, places_.length_m);
    const SmoothDeviation y(draw_, places_.length_m);
    const SmoothDeviation z(draw_, places_.length_m);
    const SmoothDeviation yaw(draw_, places_.length_m);
    const SmoothDeviation pitch(draw_, places_.length_m);
    Deviations deviations;
    for (const double along_m : places_.along_m) {
      const double share = places_.length_m > 0 ? along_m / places_.length_m : 0;
      deviations.offset_m.emplace_back(sideways_m * x(share), sideways_m * y(share),
                                       upwards_m * z(share));
      deviations.yaw_rad.push_back(yaw_rad * yaw(share));
      deviations.pitch_rad.push_back(pitch_rad * pitch(share));
    }
    return deviations;
  }

  CameraPath deviated(const Deviations& deviations, const std::vector<double>& gain) const {
    std::vector<Waypoint> waypoints = path_.waypoints();
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      waypoints[i].position_m += gain[i] * deviations.offset_m[i];
      const Eigen::AngleAxisd turn(deviations.yaw_rad[i], Vector3d::UnitZ());
      waypoints[i].direction =
          turn * waypoints[i].direction.normalized() + Vector3d(0, 0, deviations.pitch_rad[i]);
    }
    return {std::move(waypoints), path_.closed()};
  }

  /// A random walk. Where it comes too near to the surface, it is drawn back to the scene's path.
  CameraPath drawn_walk() {
    constexpr int rounds = 80;
    const Deviations deviations = drawn_deviations();
    std::vector<double> gain(path_.waypoints().size(), 1);
    for (int round = 0; round < rounds; ++round) {
      const CameraPath walk = deviated(deviations, gain);
      const std::vector<double> bad = bad_places(walk);
      if (bad.empty()) return walk;
      draw_back(gain, bad);
    }
    return deviated(deviations, std::vector<double>(gain.size(), 0));
  }

  /// The spline parameters at which a walk is too near to the surface, or behind it.
  std::vector<double> bad_places(const CameraPath& walk) const {
    std::vector<double> bad;
    for (const PathSample& sample : samples_) {
      const Vector3d place_m = walk.pose_at(sample.u).translation();
      const double wanted_m = std::min(clearance_m, sample.clearance_m);
      const Vector3d off_m = place_m - sample.pose.translation();
      const bool is_behind = off_m.norm() > 0 && rays_.cast(sample.pose.translation(),
                                                            off_m.normalized(), off_m.norm());
      if (is_behind || (off_m.norm() > 1e-9 && rays_.clearance_m(place_m, 1) < wanted_m)) {
        bad.push_back(sample.u);
      }
    }
    return bad;
  }

  /// Reduces the gains of waypoints near bad places.
  void draw_back(std::vector<double>& gain, const std::vector<double>& bad) const {
    constexpr double reach_m = 0.6;
    constexpr double strength = 0.25;
    constexpr double least_gain = 0.02;
    const auto count = gain.size();
    std::vector<double> pull(count, 0);
    for (const double u : bad) {
      // The waypoint whose weight is largest at u: the spline of an open path begins with its
      // first waypoint, which counts three times.
      const int last = static_cast<int>(count) - 1;
      const int nearest = static_cast<int>(std::lround(u)) - (path_.closed() ? 0 : 1);
      const auto middle = static_cast<std::size_t>(path_.closed() ? nearest % (last + 1)
                                                                  : std::clamp(nearest, 0, last));
      for (std::size_t i = 0; i < count; ++i) {
        const double ratio = places_.between_m(i, middle, path_.closed()) / reach_m;
        pull[i] = std::max(pull[i], std::exp(-ratio * ratio));
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      gain[i] *= 1 - strength * pull[i];
      if (gain[i] < least_gain) gain[i] = 0;
    }
  }

  /// How different a walk is from the scene's path, 1 or more if it is different enough: the mean
  /// distance to the nearest place of that path and the mean angle between the viewing directions
  /// there, each as a share of what is wanted.
  double deviation_of(const CameraPath& walk) const {
    constexpr double wanted_m = 0.3;
    constexpr double wanted_rad = 0.12;
    double sum_m = 0;
    double sum_rad = 0;
    int count = 0;
    constexpr std::size_t compared = 60;
    const std::size_t stride = std::max<std::size_t>(1, samples_.size() / compared);
    for (std::size_t i = 0; i < samples_.size(); i += stride) {
      const Pose pose = walk.pose_at(samples_[i].u);
      double nearest_m = std::numeric_limits<double>::infinity();
      double angle_rad = 0;
      for (const PathSample& sample : samples_) {
        const double distance_m = (sample.pose.translation() - pose.translation()).norm();
        if (distance_m >= nearest_m) continue;
        nearest_m = distance_m;
        angle_rad = rotation_angle_rad(sample.pose, pose);
      }
      sum_m += nearest_m;
      sum_rad += angle_rad;
      ++count;
    }
    return std::min(sum_m / count / wanted_m, sum_rad / count / wanted_rad);
  }

  CameraPath begun_elsewhere(const CameraPath& walk) {
    if (!walk.closed()) return walk;
    std::vector<Waypoint> waypoints = walk.waypoints();
    const int count = static_cast<int>(waypoints.size());
    const int first = static_cast<int>(draw_.between(0.2, 0.8) * count);
    std::rotate(waypoints.begin(), waypoints.begin() + first, waypoints.end());
    return {std::move(waypoints), true};
  }

  CameraPath path_;
  RayScene rays_;
  WaypointPlaces places_;
  std::vector<PathSample> samples_;
  RandomDraw draw_;
};

}  // namespace

CameraPath other_walk(const Scene& scene, int seed) {
  if (seed == 0 || scene.path.empty()) return scene.path;
  return WalkSearch(scene, seed).found();
}

}  // namespace tofmap

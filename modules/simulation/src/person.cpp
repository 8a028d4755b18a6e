// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/person.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

namespace tofmap {
namespace {

using Eigen::Vector3d;

/// An ellipse across a limb. Its half axes are vectors.
struct Ring {
  Vector3d centre;
  Vector3d side;
  Vector3d front;
};

/// Adds the surface through a row of rings, closed at both ends.
void add_rings(TriangleMesh& mesh, const std::vector<Ring>& rings, double reflectance) {
  constexpr std::uint32_t sides = 14;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto add = [&](const Vector3d& point) {
    mesh.vertices.push_back(point.cast<float>());
    mesh.reflectance.push_back(static_cast<float>(reflectance));
  };
  for (const Ring& ring : rings) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      add(ring.centre + std::cos(angle) * ring.side + std::sin(angle) * ring.front);
    }
  }
  add(rings.front().centre);
  add(rings.back().centre);
  const auto last = first + static_cast<std::uint32_t>(rings.size() - 1) * sides;
  const std::uint32_t ends = last + sides;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t next = (i + 1) % sides;
    for (std::uint32_t row = first; row < last; row += sides) {
      mesh.triangles.push_back({row + i, row + next, row + sides + next});
      mesh.triangles.push_back({row + i, row + sides + next, row + sides + i});
    }
    mesh.triangles.push_back({ends, first + next, first + i});
    mesh.triangles.push_back({ends + 1, last + i, last + next});
  }
}

/// Adds a limb from one joint to another, with a round cross section and rounded ends.
void add_limb(TriangleMesh& mesh, const Vector3d& from, double from_radius_m, const Vector3d& to,
              double to_radius_m, double reflectance) {
  const Vector3d axis = (to - from).normalized();
  const Vector3d side = axis.unitOrthogonal();
  const Vector3d front = axis.cross(side);
  std::vector<Ring> rings;
  const auto add = [&](const Vector3d& joint, double radius_m, double beyond) {
    const double width = radius_m * std::sqrt(1 - beyond * beyond);
    rings.push_back({joint + beyond * radius_m * axis, width * side, width * front});
  };
  for (const double beyond : {-0.98, -0.8, -0.4, 0.0}) add(from, from_radius_m, beyond);
  for (const double beyond : {0.0, 0.4, 0.8, 0.98}) add(to, to_radius_m, beyond);
  add_rings(mesh, rings, reflectance);
}

/// The unit vector that points down and is swung forward, about the axis from right to left.
Vector3d swung(double angle_rad) { return {std::sin(angle_rad), 0, -std::cos(angle_rad)}; }

// The body is built around the middle of the hips, x forward, y left, z up, metres. All lengths are
// shares of the height.

constexpr double thigh = 0.245;
constexpr double shank = 0.246;

/// Adds a leg whose thigh is at `phase` of the stride. The knee bends while the leg swings forward.
void add_leg(TriangleMesh& mesh, const PersonLook& look, double side, double phase_rad,
             double swing_rad) {
  const double h = look.height_m;
  const double thigh_rad = swing_rad * std::sin(phase_rad);
  const double knee_rad = 0.05 + 2.0 * swing_rad * std::max(0.0, std::cos(phase_rad));
  const Vector3d hip(0, side * 0.05 * h, 0);
  const Vector3d knee = hip + thigh * h * swung(thigh_rad);
  const Vector3d ankle = knee + shank * h * swung(thigh_rad - knee_rad);
  add_limb(mesh, hip, 0.048 * h, knee, 0.033 * h, look.trousers);
  add_limb(mesh, knee, 0.033 * h, ankle, 0.024 * h, look.trousers);
  // The foot pitches half as much as the shank.
  const double pitch_rad = 0.5 * (thigh_rad - knee_rad);
  const Vector3d ahead(std::cos(pitch_rad), 0, std::sin(pitch_rad));
  const Vector3d up(-std::sin(pitch_rad), 0, std::cos(pitch_rad));
  const auto ring = [&](double along, double width, double top) {
    constexpr double sole = -0.039;
    return Ring{ankle + h * (along * ahead + (sole + top / 2) * up), h * width * Vector3d::UnitY(),
                h * top / 2 * up};
  };
  add_rings(mesh,
            {ring(-0.04, 0.012, 0.03), ring(-0.02, 0.022, 0.05), ring(0.03, 0.024, 0.05),
             ring(0.08, 0.028, 0.03), ring(0.11, 0.012, 0.015)},
            look.shoes);
}

void add_arm(TriangleMesh& mesh, const PersonLook& look, double side, double angle_rad) {
  const double h = look.height_m;
  const Vector3d shoulder(0, side * 0.118 * h, 0.28 * h);
  const Vector3d outwards(0, 0.08 * side, 0);
  const Vector3d elbow = shoulder + 0.186 * h * (swung(angle_rad) + outwards).normalized();
  const Vector3d fore = swung(angle_rad + 0.25 + 0.3 * std::abs(angle_rad));
  const Vector3d wrist = elbow + 0.146 * h * fore;
  add_limb(mesh, shoulder, 0.03 * h, elbow, 0.024 * h, look.shirt);
  add_limb(mesh, elbow, 0.024 * h, wrist, 0.016 * h, look.shirt);
  add_limb(mesh, wrist, 0.016 * h, wrist + 0.07 * h * fore, 0.022 * h, look.skin);
}

void add_trunk(TriangleMesh& mesh, const PersonLook& look) {
  const double h = look.height_m;
  const auto ring = [h](double height, double width, double depth, double ahead = 0) {
    return Ring{h * Vector3d(ahead, 0, height), h * width * Vector3d::UnitY(),
                -h * depth * Vector3d::UnitX()};
  };
  add_rings(mesh,
            {ring(-0.05, 0.06, 0.05), ring(-0.02, 0.092, 0.065), ring(0.03, 0.098, 0.068),
             ring(0.06, 0.092, 0.063)},
            look.trousers);
  add_rings(mesh,
            {ring(0.06, 0.094, 0.065), ring(0.12, 0.086, 0.06), ring(0.2, 0.1, 0.07),
             ring(0.26, 0.108, 0.07), ring(0.29, 0.1, 0.055), ring(0.305, 0.06, 0.04)},
            look.shirt);
  add_rings(mesh, {ring(0.29, 0.035, 0.035), ring(0.35, 0.032, 0.033, 0.01)}, look.skin);
  // The face, and a cap of hair on top and behind.
  add_rings(mesh,
            {ring(0.335, 0.02, 0.025, 0.02), ring(0.35, 0.036, 0.045, 0.012),
             ring(0.385, 0.044, 0.054, 0.01), ring(0.42, 0.044, 0.056, 0.008),
             ring(0.45, 0.034, 0.044, 0.006)},
            look.skin);
  add_rings(mesh,
            {ring(0.395, 0.035, 0.04, -0.018), ring(0.425, 0.047, 0.056, 0),
             ring(0.45, 0.038, 0.048, 0.002), ring(0.467, 0.014, 0.018, 0.002)},
            look.hair);
}

}  // namespace

double stride_m(const PersonLook& look) {
  return 4 * (thigh + shank) * look.height_m * std::sin(max_swing_rad);
}

void add_person(TriangleMesh& mesh, const PersonLook& look, const PersonStance& stance) {
  const std::size_t first = mesh.vertices.size();
  add_trunk(mesh, look);
  for (const double side : {1.0, -1.0}) {
    const double phase_rad = stance.gait_rad + (side > 0 ? 0 : std::numbers::pi);
    add_leg(mesh, look, side, phase_rad, stance.swing_rad);
    add_arm(mesh, look, side, -0.8 * stance.swing_rad * std::sin(phase_rad));
  }
  float lowest = std::numeric_limits<float>::infinity();
  for (std::size_t i = first; i < mesh.vertices.size(); ++i) {
    lowest = std::min(lowest, mesh.vertices[i].z());
  }
  const Eigen::AngleAxisd turn(stance.heading_rad, Vector3d::UnitZ());
  for (std::size_t i = first; i < mesh.vertices.size(); ++i) {
    const Vector3d raised = mesh.vertices[i].cast<double>() - Vector3d(0, 0, lowest);
    mesh.vertices[i] = (stance.foot_m + turn * raised).cast<float>();
  }
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/simulation/pixel_label.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

constexpr double wavelength_m = 5;
constexpr double spacing_rad = 0.002;  // of rays

/// A plane x · normal = offset.
struct Plane {
  Eigen::Vector3d normal;
  double offset;
};

Plane facing(double range_m) { return {Eigen::Vector3d::UnitZ(), range_m}; }

/// Turned about the vertical, and met by the optical axis at this range.
Plane slanted(double range_m, double incidence_deg) {
  const double angle = incidence_deg * std::numbers::pi / 180;
  const Eigen::Vector3d normal(std::sin(angle), 0, std::cos(angle));
  return {normal, range_m * normal.z()};
}

SubRay ray_to(const Plane& plane, double x, double y) {
  SubRay ray{Eigen::Vector3d(x, y, 1).normalized(), RayHit{}};
  const double cos = ray.direction.dot(plane.normal);
  ray.hit->range_m = plane.offset / cos;
  ray.hit->cos_incidence = std::abs(cos);
  ray.hit->normal = plane.normal;
  return ray;
}

/// 3 x 3 rays, the columns from `first_right` on to another plane.
std::vector<SubRay> pixel(const Plane& left, const Plane& right, int first_right) {
  std::vector<SubRay> rays;
  for (int row = -1; row <= 1; ++row) {
    for (int col = -1; col <= 1; ++col) {
      rays.push_back(
          ray_to(col + 1 < first_right ? left : right, col * spacing_rad, row * spacing_rad));
    }
  }
  return rays;
}

float phase_of(double range_m) {
  const double cycles = range_m / wavelength_m;
  return static_cast<float>(cycles - std::floor(cycles));
}

PixelLabel label(const std::vector<SubRay>& rays, double range_m, double sigma_m = 0.01) {
  return label_pixel(rays, phase_of(range_m), wavelength_m, sigma_m);
}

TEST(PixelLabel, OfOneSurfaceIsRightOrNoisy) {
  const std::vector<SubRay> rays = pixel(facing(8), facing(8), 0);
  EXPECT_EQ(label(rays, 8), PixelLabel::right);
  EXPECT_EQ(label(rays, 8.09), PixelLabel::right);
  EXPECT_EQ(label(rays, 8.12), PixelLabel::noisy);
  EXPECT_EQ(label(rays, 7.88), PixelLabel::noisy);
}

TEST(PixelLabel, DoesNotMindWraps) {
  const std::vector<SubRay> rays = pixel(facing(8), facing(8), 0);
  EXPECT_EQ(label(rays, 3), PixelLabel::right);
  EXPECT_EQ(label(rays, 5.5), PixelLabel::noisy);
}

TEST(PixelLabel, OfASlantedSurfaceIsNotMixed) {
  for (const double incidence_deg : {60.0, 80.0, 88.0}) {
    const Plane plane = slanted(8, incidence_deg);
    EXPECT_EQ(label(pixel(plane, plane, 0), 8), PixelLabel::right) << incidence_deg;
  }
}

TEST(PixelLabel, OfACornerWhereSurfacesMeetIsNotMixed) {
  // Two walls that meet on the axis, seen at 70° and 20°.
  EXPECT_EQ(label(pixel(slanted(8, 70), slanted(8, -20), 1), 8), PixelLabel::right);
  EXPECT_EQ(label(pixel(slanted(8, 70), slanted(8, -20), 2), 8), PixelLabel::right);
}

TEST(PixelLabel, OfTwoSurfacesIsMixedOnOneOfThemAndFlyingBetween) {
  for (const int first_right : {1, 2}) {
    const std::vector<SubRay> rays = pixel(facing(6), facing(7), first_right);
    EXPECT_EQ(label(rays, 6), PixelLabel::mixed);
    EXPECT_EQ(label(rays, 6.96), PixelLabel::mixed);
    EXPECT_EQ(label(rays, 6.5), PixelLabel::flying);
    EXPECT_EQ(label(rays, 7.4), PixelLabel::flying);
    EXPECT_EQ(label(rays, 6.5, 0.2), PixelLabel::mixed) << "within three standard deviations";
  }
}

TEST(PixelLabel, HearsNothingOfRaysThatMeetNothing) {
  std::vector<SubRay> rays = pixel(facing(6), facing(7), 1);
  for (SubRay& ray : rays) {
    if (ray.hit->range_m > 6.5) ray.hit.reset();
  }
  EXPECT_EQ(label(rays, 6), PixelLabel::right);
  EXPECT_EQ(label_pixel(rays, NAN, wavelength_m, 0.01), PixelLabel::no_return);
}

TEST(PixelLabel, OfAConvexRoomIsNeverMixedAndOfAnOpeningItIs) {
  const auto labels_of = [](const char* scene) {
    SimulatorOptions options;
    options.frames = 2;
    return Simulator(make_scene(scene), options).simulate(1).label;
  };
  const auto mixed = static_cast<int>(PixelLabel::mixed);
  EXPECT_EQ((labels_of("wall") >= mixed).count(), 0);
  const ImageU8 labels = labels_of("slope");
  EXPECT_GT((labels == mixed).count(), 50);
  EXPECT_GT((labels == static_cast<int>(PixelLabel::flying)).count(), 50);
  EXPECT_GT((labels == static_cast<int>(PixelLabel::right)).count(), 0.9 * labels.size());
}

}  // namespace
}  // namespace tofmap

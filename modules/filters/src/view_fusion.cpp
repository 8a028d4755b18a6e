// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/view_fusion.hpp"

#include "size_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace tofmap {
namespace {

/// Surfaces that are seen at a larger angle of incidence cannot be told from edges.
constexpr double steepest_rad = 80 * std::numbers::pi / 180;

double square(double value) { return value * value; }

/// Variance of a range or depth. Averaging lowers only the part of the noise.
struct Variance {
  double noise_m2;
  double systematic_m2;

  double sum_m2() const { return noise_m2 + systematic_m2; }
};

/// The surface of a view, interpolated between four pixels.
struct Sample {
  double depth_m;
  Variance variance;  ///< of the depth
  double confidence;
};

/// Another view, as seen from the camera whose frame is fused.
class OtherView {
 public:
  OtherView(const PosedView& view, const Pose& world_from_camera, const CameraModel& camera,
            const PixelRays& rays)
      : image_(*view.image),
        other_from_camera_(view.world_from_camera.inverse() * world_from_camera),
        camera_(camera),
        rays_(rays) {}

  /// Transforms a point from the frame of the camera into that of the other camera.
  Eigen::Vector3d point_m(const Eigen::Vector3d& in_camera_m) const {
    return other_from_camera_ * in_camera_m;
  }

  /// The surface at the pixel onto which a point in the other camera's frame projects. Empty if
  /// that is outside the image or between two surfaces.
  std::optional<Sample> sample(const Eigen::Vector3d& point_m) const {
    const std::optional<Eigen::Vector2d> pixel = project(camera_, point_m);
    if (!pixel) return std::nullopt;
    const double u = std::floor(pixel->x());
    const double v = std::floor(pixel->y());
    const auto cols = static_cast<double>(image_.cols());
    const auto rows = static_cast<double>(image_.rows());
    if (!(u >= 0 && v >= 0 && u + 1 < cols && v + 1 < rows)) return std::nullopt;
    return between(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(u), pixel->y() - v,
                   pixel->x() - u);
  }

 private:
  /// Interpolates between four pixels in inverse depth, in which planes are linear.
  std::optional<Sample> between(Eigen::Index row, Eigen::Index col, double down,
                                double right) const {
    if (!have_one_surface(row, col)) return std::nullopt;
    double inverse = 0;
    double variance = 0;
    double confidence = 1;
    for (Eigen::Index r = 0; r < 2; ++r) {
      for (Eigen::Index c = 0; c < 2; ++c) {
        const double share = (r == 0 ? 1 - down : down) * (c == 0 ? 1 - right : right);
        const double ray_z = rays_.z(row + r, col + c);
        inverse += share / (image_.range_m(row + r, col + c) * ray_z);
        variance += square(share * image_.sigma_m(row + r, col + c) * ray_z);
        confidence = std::min<double>(confidence, image_.confidence(row + r, col + c));
      }
    }
    const double systematic_m = image_.systematic_m * rays_.z(row, col);
    return Sample{1 / inverse, {variance, square(systematic_m)}, confidence};
  }

  /// Whether the four pixels from (row, col) on are valid and without a step between them.
  bool have_one_surface(Eigen::Index row, Eigen::Index col) const {
    const auto ranges = image_.range_m.block<2, 2>(row, col);
    if (!ranges.isFinite().all()) return false;
    const double spacing_rad = std::hypot(rays_.x(row, col + 1) - rays_.x(row, col),
                                          rays_.y(row, col + 1) - rays_.y(row, col));
    constexpr double sigmas = 3;
    const double largest_sigma_m =
        std::hypot(image_.sigma_m.block<2, 2>(row, col).maxCoeff(), image_.systematic_m);
    const double error_m = sigmas * std::numbers::sqrt2 * largest_sigma_m;
    const double diagonal_rad = std::numbers::sqrt2 * spacing_rad;
    return ranges.maxCoeff() - ranges.minCoeff() <=
           std::tan(steepest_rad) * diagonal_rad * ranges.minCoeff() + error_m;
  }

  const RangeImage& image_;
  Pose other_from_camera_;
  const CameraModel& camera_;
  const PixelRays& rays_;
};

/// Where a ray meets the surface of another view.
struct Meeting {
  double range_m;
  Variance variance;  ///< of the range, from the errors of the other view
  double confidence;
};

/// Result of comparing a pixel with another view.
struct Finding {
  std::optional<Meeting> meeting;    ///< empty if the ray meets no surface within reach
  bool violates_free_space = false;  ///< the other view sees through the pixel's point
};

/// Searches along a ray, starting at `range_m`, for the point where it meets the surface of the
/// other view (secant method).
Finding look(const OtherView& other, const Eigen::Vector3d& ray, double range_m, double variance_m2,
             const FusionOptions& options) {
  struct Gap {
    Sample sample;
    double behind_m;  ///< depth of the surface minus that of the ray's point, other camera
  };
  const auto gap_at = [&](double at_m) -> std::optional<Gap> {
    const Eigen::Vector3d point = other.point_m(at_m * ray);
    const std::optional<Sample> sample = other.sample(point);
    if (!sample) return std::nullopt;
    return Gap{*sample, sample->depth_m - point.z()};
  };
  Finding finding;
  const std::optional<Gap> first = gap_at(range_m);
  if (!first) return finding;
  // Along the ray a surface may be displaced by noise, and by errors of the poses, which slanted
  // surfaces amplify.
  const double reach_m =
      2 * (options.max_sigmas * std::sqrt(variance_m2 + first->sample.variance.sum_m2()) +
           options.tolerance_m / std::cos(steepest_rad));
  finding.violates_free_space = first->behind_m > reach_m;

  double slope = other.point_m(ray).z() - other.point_m(Eigen::Vector3d::Zero()).z();
  double at_m = range_m;
  double behind_m = first->behind_m;
  std::optional<Gap> gap = first;
  constexpr int steps = 2;
  for (int i = 0; i < steps; ++i) {
    if (!(slope > 0)) return finding;  // the ray does not approach the surface
    const double next_m = at_m + behind_m / slope;
    if (std::abs(next_m - range_m) > reach_m) return finding;
    if (next_m == at_m) break;
    gap = gap_at(next_m);
    if (!gap) return finding;
    slope = (behind_m - gap->behind_m) / (next_m - at_m);
    at_m = next_m;
    behind_m = gap->behind_m;
  }
  if (!(slope > 0)) return finding;
  finding.violates_free_space = false;
  const Variance& depth = gap->sample.variance;
  finding.meeting = Meeting{at_m + behind_m / slope,
                            {depth.noise_m2 / square(slope), depth.systematic_m2 / square(slope)},
                            gap->sample.confidence};
  return finding;
}

/// Sums of a weighted mean and of the variance of its noise.
struct Mean {
  double value = 0;     ///< sum of weighted values
  double weight = 0;    ///< sum of weights
  double variance = 0;  ///< sum of variances times squared weights

  void add(double with_weight, double of, double its_variance) {
    value += with_weight * of;
    weight += with_weight;
    variance += square(with_weight) * its_variance;
  }
};

/// Lower limit of the confidence in weights.
constexpr double least_trust = 0.01;

/// Lower limit of the standard deviation of a range in weights.
constexpr double least_sigma_m = 1e-4;

double weight_of(double confidence, const Variance& variance) {
  return std::max(confidence, least_trust) / std::max(variance.sum_m2(), square(least_sigma_m));
}

/// Fuses or drops one valid pixel of `out`.
void fuse_pixel(Eigen::Index row, Eigen::Index col, const std::vector<OtherView>& others,
                const PixelRays& rays, const FusionOptions& options, RangeImage& out) {
  constexpr int least_violations = 2;
  const double range_m = out.range_m(row, col);
  const Variance variance{square(out.sigma_m(row, col)), square(out.systematic_m)};
  const Eigen::Vector3d ray(rays.x(row, col), rays.y(row, col), rays.z(row, col));
  Mean mean;
  mean.add(weight_of(out.confidence(row, col), variance), range_m, variance.noise_m2);
  int free_space_violation = 0;
  int agreeing = 0;
  for (const OtherView& other : others) {
    const Finding finding = look(other, ray, range_m, variance.sum_m2(), options);
    free_space_violation += finding.violates_free_space ? 1 : 0;
    if (!finding.meeting) continue;
    const Meeting& meeting = *finding.meeting;
    const double tolerated_m2 =
        square(options.max_sigmas) * (variance.sum_m2() + meeting.variance.sum_m2()) +
        square(options.tolerance_m);
    const double room = 1 - square(meeting.range_m - range_m) / tolerated_m2;
    if (!(room > 0)) continue;
    ++agreeing;
    mean.add(square(room) * weight_of(meeting.confidence, meeting.variance), meeting.range_m,
             meeting.variance.noise_m2);
  }
  if (free_space_violation >= least_violations && free_space_violation > agreeing) {
    out.invalidate(row, col, InvalidReason::free_space_violation);
    return;
  }
  out.range_m(row, col) = static_cast<float>(mean.value / mean.weight);
  out.sigma_m(row, col) = static_cast<float>(std::sqrt(mean.variance) / mean.weight);
}

}  // namespace

std::vector<OptionField<FusionOptions>> FusionOptions::fields() {
  using O = FusionOptions;
  return {
      {"views", &O::views, 0, 100, "",
       "number of frames before and after each frame that are fused with it; 0 turns fusion off"},
      {"max_sigmas", &O::max_sigmas, 0, 100, "",
       "averages only ranges of other views that differ by fewer standard deviations"},
      {"tolerance_m", &O::tolerance_m, 0, 10, "m",
       "accepted displacement of surfaces by errors of the poses"},
  };
}

RangeImage fuse_views(const PosedView& view, std::span<const PosedView> others,
                      const CameraModel& camera, const PixelRays& rays,
                      const FusionOptions& options) {
  std::vector<OtherView> looks;
  check_size(*view.image, rays, "view fusion");
  for (const PosedView& other : others) {
    check_size(*other.image, rays, "view fusion");
    looks.emplace_back(other, view.world_from_camera, camera, rays);
  }
  RangeImage out = *view.image;
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    for (Eigen::Index col = 0; col < out.cols(); ++col) {
      if (out.valid(row, col)) fuse_pixel(row, col, looks, rays, options, out);
    }
  }
  return out;
}

}  // namespace tofmap

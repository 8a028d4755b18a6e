// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/consistency.hpp"

#include "tofmap/diagnostics/view_disagreement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <pcl/kdtree/impl/kdtree_flann.hpp>
#include <pcl/kdtree/kdtree_flann.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : nan; }

/// A phase difference, wrapped to −1/2 … 1/2 cycles.
double nearest_cycle(double cycles) { return cycles - std::round(cycles); }

/// The inter-frequency residual of each pixel at its wrap count, in cycles of
/// frequency `b`. NaN where the range is invalid or a phase is missing.
ImageF phase_residuals(const RangedFrame& ranged, const Modulation& modulation, std::size_t b) {
  const double ratio = modulation.wavelength_m(0) / modulation.wavelength_m(b);
  const RangeImage& image = *ranged.image;
  if (!same_size(image.range_m, ranged.frame->phases[0]) ||
      !same_size(image.range_m, ranged.frame->phases[b])) {
    throw UsageError("consistency: ranges and phases differ in size");
  }
  ImageF residuals = ImageF::Constant(image.rows(), image.cols(), static_cast<float>(nan));
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    const double phase_a = ranged.frame->phases[0].data()[i];
    const double phase_b = ranged.frame->phases[b].data()[i];
    if (image.reason.data()[i] != 0 || std::isnan(phase_a) || std::isnan(phase_b)) continue;
    const double cycles_a = phase_a + image.wrap_count.data()[i];
    residuals.data()[i] = frequency_residual_cycles(
        static_cast<float>(cycles_a), static_cast<float>(phase_b), static_cast<float>(ratio));
  }
  return residuals;
}

/// The mean residual of the neighbourhood of a pixel.
struct LocalMean {
  double cycles = 0;
  double standard_error = 0;  ///< by the scatter of the residuals
  int pixels = 0;

  /// Whether the mean is precise enough to tell apart two wrap counts whose residuals differ by
  /// `step_cycles`: half of that difference exceeds three standard errors.
  bool tells_apart(double step_cycles) const {
    constexpr int least_pixels = 9;  // those around a corner of the image
    constexpr double sigmas = 3;
    return pixels >= least_pixels && sigmas * standard_error < step_cycles / 2;
  }

  /// Whether another wrap count, which changes residuals by `step_cycles`, would fit better.
  bool is_misfit(double step_cycles) const { return std::abs(cycles) > step_cycles / 2; }
};

/// The mean residual of the 5 x 5 pixels around a pixel, including the pixel itself, that have the
/// same wrap count.
LocalMean mean_around(const ImageF& residuals, const ImageU8& counts, Eigen::Index row,
                      Eigen::Index col) {
  constexpr Eigen::Index radius = 2;
  double sum = 0;
  double square_sum = 0;
  int pixels = 0;
  const Eigen::Index last_row = std::min(residuals.rows() - 1, row + radius);
  const Eigen::Index last_col = std::min(residuals.cols() - 1, col + radius);
  for (Eigen::Index r = std::max<Eigen::Index>(0, row - radius); r <= last_row; ++r) {
    for (Eigen::Index c = std::max<Eigen::Index>(0, col - radius); c <= last_col; ++c) {
      if (std::isnan(residuals(r, c)) || counts(r, c) != counts(row, col)) continue;
      // Average the differences from the pixel's own residual: residuals wrap at half a cycle.
      const double difference = nearest_cycle(residuals(r, c) - residuals(row, col));
      sum += difference;
      square_sum += difference * difference;
      ++pixels;
    }
  }
  // 0 / 0 for a single pixel, whose scatter is unknown.
  const double variance = std::max(0.0, square_sum - sum * sum / pixels) / (pixels - 1);
  return {nearest_cycle(residuals(row, col) + sum / pixels), std::sqrt(variance / pixels), pixels};
}

/// The smallest change of the residual that another wrap count of A makes, in cycles of B. Only
/// wrap counts up to three away are considered. NaN if none of them changes the residual.
double smallest_step_cycles(const Modulation& modulation, std::size_t b) {
  constexpr int counts = 4;
  const double step_cycles =
      residual_step_m(modulation.wavelength_m(0), modulation.wavelength_m(b), counts) /
      modulation.wavelength_m(b);
  return step_cycles < 1 ? step_cycles : nan;
}

/// Points of one frame that are projected into another: how many fall on a valid range and are not
/// hidden, and how many of these violate free space.
struct Overlap {
  int points = 0;
  int free_space_violation = 0;
};

Overlap overlap(const RangedFrame& from, const RangedFrame& to, const CameraModel& camera,
                const PixelRays& rays) {
  constexpr Eigen::Index stride = 4;
  constexpr double least_tolerance_m = 0.1;  // a coarse map is blurred by this much anyway
  constexpr double sigmas = 4;
  const Pose to_from_from = to.world_from_camera->inverse() * *from.world_from_camera;
  Overlap result;
  for (Eigen::Index v = 0; v < from.image->rows(); v += stride) {
    for (Eigen::Index u = 0; u < from.image->cols(); u += stride) {
      if (!from.image->valid(v, u)) continue;
      const double range_m = from.image->range_m(v, u);
      const Eigen::Vector3d point_m =
          to_from_from * (range_m * Eigen::Vector3d(rays.x(v, u), rays.y(v, u), rays.z(v, u)));
      const std::optional<Eigen::Vector2d> pixel = project(camera, point_m);
      if (!pixel) continue;
      const auto col = static_cast<Eigen::Index>(std::lround(pixel->x()));
      const auto row = static_cast<Eigen::Index>(std::lround(pixel->y()));
      if (row < 0 || col < 0 || row >= to.image->rows() || col >= to.image->cols()) continue;
      if (!to.image->valid(row, col)) continue;
      const double behind_m = to.image->range_m(row, col) - point_m.norm();
      const double variance_m2 = from.image->variance_m2(v, u) + to.image->variance_m2(row, col);
      const double tolerance_m = std::max(least_tolerance_m, sigmas * std::sqrt(variance_m2));
      if (behind_m < -tolerance_m) continue;  // hidden: no evidence either way
      ++result.points;
      result.free_space_violation += behind_m > tolerance_m ? 1 : 0;
    }
  }
  return result;
}

using Tree = pcl::KdTreeFLANN<MapPoint>;

/// RMS distance of the points around a map point from their common plane, metres. Empty if the
/// surface is not planar there or has too few points.
std::optional<double> thickness_at(const MapCloud& map, const Tree& tree, int index) {
  constexpr double radius_m = 0.15;
  constexpr double same_direction = 0.94;  // cosine of 20 degrees
  constexpr std::size_t least_points = 12;
  std::vector<int> neighbours;
  std::vector<float> squares;
  tree.radiusSearch(map, index, radius_m, neighbours, squares);
  const Eigen::Vector3f normal = map[index].getNormalVector3fMap();
  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int i : neighbours) {
    const Eigen::Vector3f other = map[i].getNormalVector3fMap();
    if (other.dot(normal) < -same_direction) continue;  // the back of a thin object
    if (!(other.dot(normal) > same_direction)) return std::nullopt;
    points.emplace_back(map[i].getVector3fMap().cast<double>());
    mean += points.back();
  }
  if (points.size() < least_points) return std::nullopt;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    scatter += (point - mean) * (point - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]) / static_cast<double>(points.size()));
}

}  // namespace

ResidualAgreement residual_agreement(const std::vector<RangedFrame>& frames,
                                     const Modulation& modulation) {
  constexpr double least_telling_percent = 1;  // a few patches do not speak for a recording
  double square_sum = 0;
  double misfits = 0;
  double telling = 0;
  double pixels = 0;
  for (std::size_t i = 0; i < frames.size() * (modulation.count() - 1); ++i) {
    const RangedFrame& ranged = frames[i / (modulation.count() - 1)];
    const std::size_t b = 1 + i % (modulation.count() - 1);
    const double step_cycles = smallest_step_cycles(modulation, b);
    const ImageF residuals = phase_residuals(ranged, modulation, b);
    for (Eigen::Index row = 0; row < residuals.rows(); ++row) {
      for (Eigen::Index col = 0; col < residuals.cols(); ++col) {
        const double residual = residuals(row, col);
        if (std::isnan(residual)) continue;
        ++pixels;
        square_sum += residual * residual;
        const LocalMean around = mean_around(residuals, ranged.image->wrap_count, row, col);
        if (!around.tells_apart(step_cycles)) continue;
        ++telling;
        misfits += around.is_misfit(step_cycles) ? 1 : 0;
      }
    }
  }
  const bool is_known = telling >= least_telling_percent / 100 * pixels;
  return {is_known ? percent(misfits, telling) : nan,
          pixels > 0 ? std::sqrt(square_sum / pixels) : nan};
}

double ambiguous_percent(const std::vector<RangedFrame>& frames) {
  double ambiguous = 0;
  double returns = 0;
  for (const RangedFrame& ranged : frames) {
    ambiguous += count_reason(*ranged.image, InvalidReason::ambiguous);
    returns += static_cast<double>(ranged.image->reason.size()) -
               count_reason(*ranged.image, InvalidReason::no_return);
  }
  return percent(ambiguous, returns);
}

double contradicted_percent(const std::vector<RangedFrame>& frames, const CameraModel& camera) {
  constexpr int least_points = 50;  // smaller overlaps may be chance
  const PixelRays rays = pixel_rays(camera);
  std::int64_t points = 0;
  std::int64_t free_space_violation = 0;
#pragma omp parallel for schedule(dynamic, 1) reduction(+ : points, free_space_violation)
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const RangedFrame& from = frames[i];
    for (const RangedFrame& to : frames) {
      if (&from == &to || !from.world_from_camera || !to.world_from_camera) continue;
      const Overlap pair = overlap(from, to, camera, rays);
      if (pair.points < least_points) continue;
      points += pair.points;
      free_space_violation += pair.free_space_violation;
    }
  }
  return percent(static_cast<double>(free_space_violation), static_cast<double>(points));
}

double plane_thickness_m(const MapCloud& map) {
  constexpr std::size_t places = 3000;
  if (map.empty()) return nan;
  constexpr bool sorted = false;
  Tree tree(sorted);
  tree.setInputCloud(map.makeShared());
  std::vector<double> thicknesses;
  const std::size_t step = std::max<std::size_t>(1, map.size() / places);
  for (std::size_t i = 0; i < map.size(); i += step) {
    if (const auto thickness = thickness_at(map, tree, static_cast<int>(i))) {
      thicknesses.push_back(*thickness);
    }
  }
  return thicknesses.empty() ? nan : median(thicknesses);
}

Consistency unknown_consistency() { return {nan, nan, nan, nan, nan, nan, nan}; }

int consistency_frames(const CameraModel& camera) {
  constexpr double most_pixels = 6e6;
  return static_cast<int>(std::clamp(most_pixels / (camera.width_px * camera.height_px), 20., 60.));
}

Consistency consistency_of(const std::vector<RangedFrame>& unwrapped,
                           const std::vector<RangedFrame>& filtered, const MapCloud& map,
                           const SensorModel& sensor) {
  const ResidualAgreement residual = residual_agreement(unwrapped, sensor.modulation);
  return {.residual_misfit_percent = residual.misfit_percent,
          .residual_rms_cycles = residual.residual_cycles,
          .ambiguous_percent = ambiguous_percent(unwrapped),
          .contradicted_percent = contradicted_percent(filtered, sensor.camera),
          .plane_thickness_m = plane_thickness_m(map),
          .view_disagreement_m = view_disagreement_m(filtered, sensor.camera),
          .curl_violations_per_frame = nan};
}

std::vector<std::string> warnings_about(const Consistency& consistency) {
  // docs/evaluation.md has the measurements behind these limits. NaN exceeds no limit.
  constexpr double most_contradicted_percent = 3;
  constexpr double most_misfit_percent = 10;
  constexpr double most_disagreement_m = 0.006;
  std::vector<std::string> warnings;
  if (consistency.contradicted_percent > most_contradicted_percent) {
    warnings.push_back(fmt::format(
        "frames contradict each other in {:.1f} % of what they both see: ranges or poses are wrong",
        consistency.contradicted_percent));
  }
  if (consistency.residual_misfit_percent > most_misfit_percent) {
    warnings.push_back(
        fmt::format("{:.0f} % of the pixels, of those with little noise, would fit all "
                    "frequencies better with another wrap count: wrap counts are wrong, or there "
                    "is an offset between the frequencies (see 'tofmap info')",
                    consistency.residual_misfit_percent));
  }
  if (consistency.view_disagreement_m > most_disagreement_m) {
    warnings.push_back(
        fmt::format("frames disagree by {:.0f} mm about where the surfaces are that they see, not "
                    "counting noise: ranges have systematic errors, such as by stray light, or "
                    "poses are wrong ('tofmap calibrate' finds errors of the camera)",
                    1000 * consistency.view_disagreement_m));
  }
  return warnings;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/calibration/wall_reference.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>
#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Largest error of a pixel that is used to fit the wall in the first round, in wavelengths. It is
/// wide because the tilt is unknown, and is halved after each round.
constexpr double first_reach = 0.25;
constexpr int rounds = 4;

/// Smallest share of the returns that must lie on the wall.
constexpr double least_share = 0.5;

/// The ray of a pixel and the phase that A measures along it.
struct Beam {
  Eigen::Vector3d ray;
  double phase_cycles;
};

std::vector<Beam> beams_of(const Frame& frame, const PixelRays& rays) {
  std::vector<Beam> beams;
  for (Eigen::Index i = 0; i < frame.phases[0].size(); ++i) {
    const float phase = frame.phases[0].data()[i];
    if (std::isnan(phase)) continue;
    beams.push_back({{rays.x.data()[i], rays.y.data()[i], rays.z.data()[i]}, phase});
  }
  return beams;
}

/// The range along a ray to the plane normal · x = distance_m. NaN if the ray does not meet the
/// plane, or only at a grazing angle.
double range_to(const Eigen::Vector3d& normal, double distance_m, const Eigen::Vector3d& ray) {
  const double cosine = normal.dot(ray);
  constexpr double grazing = 0.05;
  return cosine > grazing ? distance_m / cosine : NAN;
}

/// Measured range minus range to the plane for each beam, with the wrap count that brings the
/// measured range nearest to the plane. NaN for beams that do not meet the plane.
std::vector<double> errors_m(const std::vector<Beam>& beams, const Eigen::Vector3d& normal,
                             double distance_m, double wavelength_m) {
  std::vector<double> errors;
  errors.reserve(beams.size());
  for (const Beam& beam : beams) {
    const double off = beam.phase_cycles - range_to(normal, distance_m, beam.ray) / wavelength_m;
    errors.push_back(wavelength_m * (off - std::round(off)));
  }
  return errors;
}

/// The median of the values that are not NaN; NaN if all are.
double median_of_known(const std::vector<double>& values) {
  std::vector<double> known;
  std::ranges::copy_if(values, std::back_inserter(known), [](double v) { return !std::isnan(v); });
  return known.empty() ? NAN : median(known);
}

}  // namespace

WallDistances read_wall_distances(const std::filesystem::path& file) {
  refuse_no_file(file);
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": cannot be read; expected lines 'frame distance_m'");
  WallDistances distances;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    words >> std::ws;
    if (words.eof()) continue;
    int frame = 0;
    double distance_m = 0;
    std::string rest;
    const bool is_valid = words >> frame >> distance_m && !(words >> rest) && frame >= 0 &&
                          distance_m > 0 && std::isfinite(distance_m);
    if (!is_valid) {
      throw InputError(file.string() + ":" + std::to_string(number) +
                       ": expected 'frame distance_m', got '" + line + "'");
    }
    if (!distances.emplace(frame, distance_m).second) {
      throw InputError(file.string() + ":" + std::to_string(number) + ": frame " +
                       std::to_string(frame) + " is given twice");
    }
  }
  if (distances.empty()) throw InputError(file.string() + ": has no line 'frame distance_m'");
  return distances;
}

void check_wall_distances(const WallDistances& distances_m, const std::filesystem::path& file,
                          const SequenceReader& recording) {
  constexpr double farthest_m = 100;
  for (const auto& [frame, distance_m] : distances_m) {
    if (distance_m <= farthest_m) continue;
    throw InputError(file.string() +
                     fmt::format(": has a wall at {:g} m in frame {}; are its distances metres?",
                                 distance_m, frame));
  }
  if (distances_m.empty()) return;
  const int last = distances_m.rbegin()->first;
  const int frames = *recording.frame_count();
  if (last < frames) return;
  throw InputError(
      file.string() +
      fmt::format(": has a distance for frame {}, but {} has {} frames, counted from 0", last,
                  recording.folder().string(), frames));
}

std::optional<ImageF> wall_range(const Frame& frame, const SensorModel& sensor, double distance_m) {
  const PixelRays rays = pixel_rays(sensor.camera);
  const std::vector<Beam> beams = beams_of(frame, rays);
  const double wavelength_m = sensor.modulation.wavelength_m(0);
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double reach_m = first_reach * wavelength_m;
  std::size_t on_wall = 0;
  for (int round = 0; round < rounds; ++round, reach_m /= 2) {
    const std::vector<double> errors = errors_m(beams, normal, distance_m, wavelength_m);
    const double offset_m = median_of_known(errors);
    // Least squares for normal / distance, in which 1 / range is linear.
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    on_wall = 0;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const double error_m = errors[i] - offset_m;
      if (!(std::abs(error_m) < reach_m)) continue;
      const double range_m = range_to(normal, distance_m, beams[i].ray) + error_m;
      const Eigen::Vector3d row = range_m * beams[i].ray;  // gives errors of ranges equal weight
      information += row * row.transpose();
      gradient += row;
      ++on_wall;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(information);
    if (on_wall < 3 || !solver.isPositive()) return std::nullopt;
    const Eigen::Vector3d solution = solver.solve(gradient);
    if (!solution.allFinite() || solution.isZero()) return std::nullopt;
    normal = solution.normalized();
  }
  if (static_cast<double>(on_wall) < least_share * static_cast<double>(beams.size())) {
    return std::nullopt;
  }
  ImageF range_m(frame.phases[0].rows(), frame.phases[0].cols());
  for (Eigen::Index i = 0; i < range_m.size(); ++i) {
    const Eigen::Vector3d ray(rays.x.data()[i], rays.y.data()[i], rays.z.data()[i]);
    range_m.data()[i] = static_cast<float>(range_to(normal, distance_m, ray));
  }
  return range_m;
}

}  // namespace tofmap

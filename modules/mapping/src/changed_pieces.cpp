// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "changed_pieces.hpp"

#include "change_noise.hpp"
#include "near_points.hpp"
#include "tofmap/mapping/change_detection.hpp"
#include "tofmap/mapping/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

namespace tofmap {
namespace {

/// How far a surface goes on beside the points that keyframes see through: closer to another
/// surface, the noise of a keyframe hides it. Pieces that are no farther apart are one.
constexpr float growth_m = 0.15F;

/// For each point, whether another surface has none there that may be the same.
std::vector<char> without_counterpart(const MapCloud& points, const MapCloud& other,
                                      float voxel_m) {
  constexpr float reach_voxels = 2;
  const float least_cosine = std::cos(static_cast<float>(M_PI) / 4);
  const NearPoints search(other, reach_voxels * voxel_m);
  std::vector<char> is_alone(points.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t at = 0; at < std::ssize(points); ++at) {
    const auto i = static_cast<std::size_t>(at);
    const Eigen::Vector3f normal = points[i].getNormalVector3fMap();
    is_alone[i] =
        search.any_near(points[i],
                        [&](std::size_t k) {
                          const Eigen::Vector3f apart_m =
                              other[k].getVector3fMap() - points[i].getVector3fMap();
                          return normal.dot(other[k].getNormalVector3fMap()) >= least_cosine &&
                                 std::abs(normal.dot(apart_m)) <= voxel_m;
                        })
            ? 0
            : 1;
  }
  return is_alone;
}

/// How many times more keyframes of another time must see through a surface than agree with it, for
/// it not to have been there then.
constexpr int times_more = 3;

/// Tells points that belong to no change.
constexpr std::size_t no_seed = std::numeric_limits<std::size_t>::max();

/// Whether points may have been there at their time, and keyframes of another time see through
/// them. `sightings` are those of these keyframes.
std::vector<char> violations_of(const SeenSurface& surface,
                                const std::vector<Sightings>& sightings) {
  std::vector<char> is_violation(surface.points.size());
  for (std::size_t i = 0; i < is_violation.size(); ++i) {
    is_violation[i] = surface.certainty[i] != Certainty::none &&
                              sightings[i].violating >= least_views &&
                              sightings[i].violating >= times_more * sightings[i].agreeing
                          ? 1
                          : 0;
  }
  return is_violation;
}

/// The seeds of changes: those points that were there with certainty, are seen through and have no
/// counterpart. Each is its own seed; all other points get `no_seed`.
std::vector<std::size_t> seeds_of_changes(const SeenSurface& surface,
                                          const std::vector<char>& is_alone,
                                          const std::vector<char>& is_violation) {
  std::vector<std::size_t> seed_of(surface.points.size(), no_seed);
  for (std::size_t i = 0; i < seed_of.size(); ++i) {
    const bool is_sure = surface.certainty[i] == Certainty::sure;
    if (is_sure && is_alone[i] != 0 && is_violation[i] != 0) seed_of[i] = i;
  }
  return seed_of;
}

/// Adds what is connected with seeds and has no counterpart either. Each point gets its seed.
/// Points that are seen through become seeds themselves.
void grow(const MapCloud& points, const NearPoints& search, const std::vector<char>& is_alone,
          const std::vector<char>& is_violation, std::vector<std::size_t>& seed_of) {
  std::vector<std::size_t> open;
  std::ranges::copy_if(seed_of, std::back_inserter(open),
                       [](std::size_t seed) { return seed != no_seed; });
  for (std::size_t done = 0; done < open.size(); ++done) {
    const std::size_t seed = seed_of[open[done]];
    search.any_near(points[open[done]], [&](std::size_t i) {
      const float gap_m = (points[i].getVector3fMap() - points[seed].getVector3fMap()).norm();
      if (seed_of[i] == no_seed && is_alone[i] != 0 && gap_m <= growth_m) {
        seed_of[i] = is_violation[i] != 0 ? i : seed;
        open.push_back(i);
      }
      return false;
    });
  }
}

/// Takes the points that are connected with a point, in ascending order.
std::vector<std::size_t> take_piece(std::size_t first, const MapCloud& points,
                                    const NearPoints& search, std::vector<char>& is_taken) {
  is_taken[first] = 1;
  std::vector<std::size_t> piece{first};
  for (std::size_t done = 0; done < piece.size(); ++done) {
    search.any_near(points[piece[done]], [&](std::size_t i) {
      if (is_taken[i] == 0) {
        is_taken[i] = 1;
        piece.push_back(i);
      }
      return false;
    });
  }
  std::ranges::sort(piece);
  return piece;
}

/// The pieces of changes, without those that are small or hardly have seeds.
std::vector<MapCloud> pieces_of(const ChangedPoints& changed, double voxel_m) {
  const MapCloud& points = changed.points;
  const NearPoints beside(points, std::max(growth_m, static_cast<float>(2 * voxel_m)));
  std::vector<MapCloud> pieces;
  std::vector<char> is_taken(points.size(), 0);
  for (std::size_t first = 0; first < points.size(); ++first) {
    if (is_taken[first] != 0) continue;
    const auto piece = take_piece(first, points, beside, is_taken);
    const auto seeds =
        std::ranges::count_if(piece, [&](std::size_t i) { return changed.is_seed[i] != 0; });
    if (3 * seeds < std::ssize(piece) || piece.size() < least_points_of_change) continue;
    MapCloud& cloud = pieces.emplace_back();
    for (const std::size_t i : piece) cloud.push_back(points[i]);
  }
  return pieces;
}

}  // namespace

std::vector<MapCloud> pieces_violating_free_space(const SeenSurface& surface,
                                                  const SeenSurface& other,
                                                  const MapContent& content) {
  const MapCloud& points = surface.points;
  const double voxel_m = content.surface_options.voxel_m;
  const NearPoints search(points, static_cast<float>(2 * voxel_m));
  const std::vector<char> is_alone =
      without_counterpart(points, other.points, static_cast<float>(voxel_m));
  const std::vector<char> is_violation =
      violations_of(surface, sightings_of(points, other.keyframes, content.camera, voxel_m));
  std::vector<std::size_t> seed_of = seeds_of_changes(surface, is_alone, is_violation);
  grow(points, search, is_alone, is_violation, seed_of);
  ChangedPoints changed;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (seed_of[i] != no_seed) changed.add(points[i], seed_of[i] == i);
  }
  return pieces_of(without_noise(changed, content.surface_options), voxel_m);
}

}  // namespace tofmap

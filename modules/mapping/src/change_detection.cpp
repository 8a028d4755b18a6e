// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/change_detection.hpp"

#include "moved_shape.hpp"
#include "near_points.hpp"
#include "tofmap/mapping/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

namespace tofmap {
namespace {

/// Number of keyframes that must see through a point. A single one may be deceived.
constexpr int least_views = 2;

/// How many times more keyframes must agree with a surface than see through it, for it to have been
/// there: edges of things, and ranges between two surfaces, are seen by some and not by others.
constexpr int times_surer = 3;

/// How far a surface goes on beside the points that keyframes see through: closer to another
/// surface, the noise of a keyframe hides it.
constexpr float growth_m = 0.15F;

/// The surface of a map, as some of its recordings saw it.
struct SeenSurface {
  MapCloud points;            ///< without free-space violations
  std::vector<char> is_sure;  ///< for each point, whether several keyframes agree with it
  std::vector<Keyframe> keyframes;
};

/// For each point, the number of keyframes whose pixels resolve its surface, occlusion aside. A
/// pixel that covers more of it, far away or at a grazing angle, mixes things.
std::vector<int> resolving_views(const MapCloud& points, std::span<const Keyframe> keyframes,
                                 const CameraModel& camera) {
  constexpr double most_covered_m = 0.15;
  std::vector<int> views(points.size(), 0);
  for (const Keyframe& keyframe : keyframes) {
    const Pose camera_from_world = keyframe.world_from_camera.inverse();
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t at = 0; at < std::ssize(points); ++at) {
      const auto i = static_cast<std::size_t>(at);
      const Eigen::Vector3d point_m = camera_from_world * points[i].getVector3fMap().cast<double>();
      const Eigen::Vector3d normal =
          camera_from_world.linear() * points[i].getNormalVector3fMap().cast<double>();
      const double cosine = -normal.dot(point_m.normalized());
      if (point_m.z() <= 0 || point_m.norm() > most_covered_m * camera.fx_px * cosine) continue;
      const auto pixel = project(camera, point_m);
      const bool is_in_view = pixel && pixel->x() >= 0 && pixel->y() >= 0 &&
                              pixel->x() < camera.width_px && pixel->y() < camera.height_px;
      views[i] += is_in_view ? 1 : 0;
    }
  }
  return views;
}

/// The surface that the recordings from `first` to before `end` saw.
SeenSurface surface_seen(const MapContent& content, int map, int first, int end) {
  SeenSurface seen;
  const auto is_seen = [&](const Keyframe& keyframe) {
    return keyframe.map == map && keyframe.recording >= first && keyframe.recording < end;
  };
  std::ranges::copy_if(content.keyframes.all(), std::back_inserter(seen.keyframes), is_seen);
  std::ranges::stable_sort(seen.keyframes, {}, &Keyframe::recording);
  const MapCloud points = merged_submaps(content, is_seen);
  const std::vector<Sightings> sightings =
      sightings_of(points, seen.keyframes, content.camera, content.surface_options.voxel_m);
  const std::vector<int> resolving = resolving_views(points, seen.keyframes, content.camera);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [violating, agreeing, since] = sightings[i];
    if (sightings[i].violates_free_space()) continue;
    seen.points.push_back(points[i]);
    const bool is_sure = resolving[i] >= least_views && agreeing >= least_views &&
                         agreeing >= times_surer * violating;
    seen.is_sure.push_back(is_sure ? 1 : 0);
  }
  return seen;
}

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

/// Tells points that belong to no change.
constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

/// The points that keyframes of another time see through: themselves, as the seeds of changes.
/// `none` for all others. `sightings` are those of these keyframes.
std::vector<std::size_t> seeds_of_changes(const SeenSurface& surface,
                                          const std::vector<char>& is_alone,
                                          const std::vector<Sightings>& sightings) {
  std::vector<std::size_t> seed_of(surface.points.size(), none);
  for (std::size_t i = 0; i < seed_of.size(); ++i) {
    const bool is_seed = is_alone[i] != 0 && surface.is_sure[i] != 0 &&
                         sightings[i].violating >= least_views &&
                         sightings[i].violates_free_space();
    if (is_seed) seed_of[i] = i;
  }
  return seed_of;
}

/// Adds what is connected with seeds and has no counterpart either. Each point gets its seed.
void grow(const MapCloud& points, const NearPoints& search, const std::vector<char>& is_alone,
          std::vector<std::size_t>& seed_of) {
  std::vector<std::size_t> open;
  std::ranges::copy_if(seed_of, std::back_inserter(open),
                       [](std::size_t seed) { return seed != none; });
  for (std::size_t done = 0; done < open.size(); ++done) {
    const std::size_t seed = seed_of[open[done]];
    search.any_near(points[open[done]], [&](std::size_t i) {
      const float gap_m = (points[i].getVector3fMap() - points[seed].getVector3fMap()).norm();
      if (seed_of[i] == none && is_alone[i] != 0 && gap_m <= growth_m) {
        seed_of[i] = seed;
        open.push_back(i);
      }
      return false;
    });
  }
}

/// Takes the points that are connected with a point and belong to a change, in ascending order.
std::vector<std::size_t> take_piece(std::size_t first, const MapCloud& points,
                                    const NearPoints& search,
                                    const std::vector<std::size_t>& seed_of,
                                    std::vector<char>& is_taken) {
  is_taken[first] = 1;
  std::vector<std::size_t> piece{first};
  for (std::size_t done = 0; done < piece.size(); ++done) {
    search.any_near(points[piece[done]], [&](std::size_t i) {
      if (seed_of[i] != none && is_taken[i] == 0) {
        is_taken[i] = 1;
        piece.push_back(i);
      }
      return false;
    });
  }
  std::ranges::sort(piece);
  return piece;
}

/// The connected pieces of a surface that keyframes of another time see through. `other` is the
/// surface that these saw.
std::vector<MapCloud> pieces_seen_through(const SeenSurface& surface, const SeenSurface& other,
                                          const MapContent& content) {
  const MapCloud& points = surface.points;
  const double voxel_m = content.surface_options.voxel_m;
  const NearPoints search(points, static_cast<float>(2 * voxel_m));
  const std::vector<char> is_alone =
      without_counterpart(points, other.points, static_cast<float>(voxel_m));
  std::vector<std::size_t> seed_of = seeds_of_changes(
      surface, is_alone, sightings_of(points, other.keyframes, content.camera, voxel_m));
  grow(points, search, is_alone, seed_of);
  std::vector<MapCloud> pieces;
  std::vector<char> is_taken(points.size(), 0);
  for (std::size_t first = 0; first < points.size(); ++first) {
    if (seed_of[first] == none || is_taken[first] != 0) continue;
    const auto piece = take_piece(first, points, search, seed_of, is_taken);
    const auto seeds = std::ranges::count_if(piece, [&](std::size_t i) { return seed_of[i] == i; });
    if (2 * seeds < std::ssize(piece) || piece.size() < least_points_of_change) continue;
    MapCloud& cloud = pieces.emplace_back();
    for (const std::size_t i : piece) cloud.push_back(points[i]);
  }
  return pieces;
}

/// The mean direction, in the world, that is up for the cameras.
Eigen::Vector3d upwards(std::span<const Keyframe> keyframes) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Keyframe& keyframe : keyframes) sum -= keyframe.world_from_camera.linear().col(1);
  return sum.norm() > 0 ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d::UnitZ();
}

/// Whether keyframes see a surface where a motion puts it, as far as they see that place.
bool may_be_at(const MapCloud& surface, const Pose& motion, const SeenSurface& seen,
               const MapContent& content) {
  constexpr double most_violations_when_moved = 0.1;
  MapCloud moved = surface;
  for (MapPoint& point : moved) {
    point.getVector3fMap() = motion.cast<float>() * Eigen::Vector3f(point.getVector3fMap());
    point.recording = 0;
  }
  const std::vector<Sightings> sightings =
      sightings_of(moved, seen.keyframes, content.camera, content.surface_options.voxel_m);
  const auto violations = std::ranges::count_if(sightings, &Sightings::violates_free_space);
  return static_cast<double>(violations) <=
         most_violations_when_moved * static_cast<double>(surface.size());
}

/// Takes out the pieces that have moved, those that fit best first. `before` and `now` are what was
/// seen before and after.
std::vector<MapChange> take_moved(std::vector<MapCloud>& gone, std::vector<MapCloud>& appeared,
                                  const SeenSurface& before, const SeenSurface& now,
                                  const MapContent& content) {
  struct Match {
    std::size_t gone, appeared;
    MovedShape moved;
  };
  // The largest pieces come first. Where there are many, most are no things.
  constexpr std::size_t most_pieces = 20;
  for (auto* pieces : {&gone, &appeared}) {
    std::ranges::stable_sort(*pieces, std::ranges::greater(),
                             [](const MapCloud& piece) { return piece.size(); });
  }
  const Eigen::Vector3d up = upwards(now.keyframes);
  std::vector<Match> matches;
  for (std::size_t i = 0; i < std::min(gone.size(), most_pieces); ++i) {
    for (std::size_t k = 0; k < std::min(appeared.size(), most_pieces); ++k) {
      const auto moved = find_motion(gone[i], appeared[k], up, content.surface_options.voxel_m);
      if (moved && may_be_at(gone[i], moved->after_from_before, now, content) &&
          may_be_at(appeared[k], moved->after_from_before.inverse(), before, content)) {
        matches.push_back({i, k, *moved});
      }
    }
  }
  std::ranges::stable_sort(matches, std::ranges::greater(),
                           [](const Match& match) { return match.moved.fit; });
  std::vector<MapChange> changes;
  for (const auto& [from, to, moved] : matches) {
    if (gone[from].empty() || appeared[to].empty()) continue;
    changes.push_back({.kind = ChangeKind::moved,
                       .before = std::exchange(gone[from], {}),
                       .after = std::exchange(appeared[to], {}),
                       .after_from_before = moved.after_from_before});
  }
  std::erase_if(gone, [](const MapCloud& piece) { return piece.empty(); });
  std::erase_if(appeared, [](const MapCloud& piece) { return piece.empty(); });
  return changes;
}

/// The changes that a recording shows, the largest of each kind first.
std::vector<MapChange> changes_in(const MapContent& content, int map, int recording) {
  const SeenSurface before = surface_seen(content, map, 0, recording);
  const SeenSurface now = surface_seen(content, map, recording, recording + 1);
  if (before.points.empty() || now.points.empty()) return {};
  std::vector<MapCloud> gone = pieces_seen_through(before, now, content);
  // What is new was first seen after the keyframes that see through it.
  SeenSurface later = now;
  for (MapPoint& point : later.points) point.recording = 0;
  std::vector<MapCloud> appeared = pieces_seen_through(later, before, content);
  for (MapCloud& piece : appeared) {
    for (MapPoint& point : piece) point.recording = static_cast<std::uint32_t>(recording);
  }
  std::vector<MapChange> changes = take_moved(gone, appeared, before, now, content);
  for (MapCloud& piece : gone) {
    changes.push_back({.kind = ChangeKind::gone, .before = std::move(piece), .after = {}});
  }
  for (MapCloud& piece : appeared) {
    changes.push_back({.kind = ChangeKind::appeared, .before = {}, .after = std::move(piece)});
  }
  for (MapChange& change : changes) {
    change.map = map;
    change.recording = recording;
  }
  std::ranges::stable_sort(changes, [](const MapChange& one, const MapChange& other) {
    return std::pair(one.kind, point_count(other)) < std::pair(other.kind, point_count(one));
  });
  return changes;
}

}  // namespace

std::vector<MapChange> find_changes(const MapContent& content, int map) {
  std::vector<MapChange> changes;
  for (int recording = 1; recording < std::ssize(content.recordings); ++recording) {
    std::ranges::move(changes_in(content, map, recording), std::back_inserter(changes));
  }
  return changes;
}

std::vector<MapChange> find_changes(const MapContent& content) {
  std::set<int> maps;
  for (const Keyframe& keyframe : content.keyframes.all()) maps.insert(keyframe.map);
  std::vector<MapChange> changes;
  for (const int map : maps) {
    std::ranges::move(find_changes(content, map), std::back_inserter(changes));
  }
  return changes;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/change_detection.hpp"

#include "changed_pieces.hpp"
#include "moved_shape.hpp"
#include "seen_surface.hpp"
#include "tofmap/mapping/free_space.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace tofmap {
namespace {

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
  std::vector<MapCloud> gone = pieces_violating_free_space(before, now, content);
  // What is new was first seen after the keyframes that see through it.
  SeenSurface later = now;
  for (MapPoint& point : later.points) point.recording = 0;
  std::vector<MapCloud> appeared = pieces_violating_free_space(later, before, content);
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

std::set<int> maps_with_keyframes(const MapContent& content) {
  std::set<int> maps;
  for (const Keyframe& keyframe : content.keyframes.all()) maps.insert(keyframe.map);
  return maps;
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
  std::vector<MapChange> changes;
  for (const int map : maps_with_keyframes(content)) {
    std::ranges::move(find_changes(content, map), std::back_inserter(changes));
  }
  return changes;
}

std::vector<MapChange> changes_since(const MapContent& content, int recording) {
  std::vector<MapChange> changes;
  for (const int map : maps_with_keyframes(content)) {
    std::ranges::move(changes_in(content, map, recording), std::back_inserter(changes));
  }
  return changes;
}

}  // namespace tofmap

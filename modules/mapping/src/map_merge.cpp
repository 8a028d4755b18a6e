// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/map_merge.hpp"

#include "tofmap/mapping/change_detection.hpp"
#include "tofmap/mapping/join_choice.hpp"
#include "tofmap/mapping/loop_closure.hpp"
#include "tofmap/mapping/map_fit.hpp"
#include "tofmap/mapping/map_join.hpp"
#include "tofmap/mapping/place_recognition.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

int maps_begun(const MapContent& content) {
  int begun = 0;
  for (const Keyframe& keyframe : content.keyframes.all()) {
    begun = std::max({begun, keyframe.map + 1, keyframe.taken_in + 1});
  }
  return begun;
}

/// The keyframes of a map with the numbers that they get after those of another one. Their worlds
/// are still apart.
std::vector<Keyframe> renumbered(const MapContent& added, const MapContent& content) {
  const int first = content.keyframes.size();
  const int first_map = maps_begun(content);
  const int first_recording = static_cast<int>(content.recordings.size());
  const double path_m = first > 0 ? content.keyframes[first - 1].path_m : 0;
  std::vector<Keyframe> keyframes;
  for (Keyframe keyframe : added.keyframes.all()) {
    keyframe.id += first;
    keyframe.map += first_map;
    keyframe.taken_in = keyframe.map;
    keyframe.recording += first_recording;
    keyframe.path_m += path_m;
    keyframes.push_back(std::move(keyframe));
  }
  return keyframes;
}

/// Adds all of a map but its keyframes, which were renumbered().
void append_rest(const MapContent& added, std::vector<Keyframe> keyframes, MapContent& content) {
  const int first = content.keyframes.size();
  const int first_submap = static_cast<int>(content.submaps.size());
  const int first_recording = static_cast<int>(content.recordings.size());
  std::ranges::copy(added.recordings, std::back_inserter(content.recordings));
  for (Keyframe& keyframe : keyframes) {
    const KeyframeCloud cloud = std::exchange(keyframe.cloud, {});
    content.keyframes.add(std::move(keyframe), [cloud] { return cloud.compact(); });
  }
  for (int id = 0; id < added.keyframes.size(); ++id) {
    const auto links = added.keyframes.links(id);
    std::vector<KeyframeLink> moved(links.begin(), links.end());
    for (KeyframeLink& link : moved) link.to += first;
    content.keyframes.set_links(first + id, std::move(moved));
  }
  for (const Submap& submap : added.submaps) {
    content.submaps.push_back({submap.anchor + first, submap.surface});
  }
  for (const int submap : added.submap_of) content.submap_of.push_back(submap + first_submap);
  for (RegisteredFrame frame : added.frames) {
    frame.keyframe += first;
    for (FrameConstraint& constraint : frame.constraints) constraint.keyframe += first;
    frame.recording += first_recording;
    content.frames.push_back(std::move(frame));
  }
  for (PoseEdge edge : added.edges) {
    edge.from += first;
    edge.to += first;
    content.edges.push_back(edge);
  }
  std::ranges::copy(added.loops, std::back_inserter(content.loops));
}

/// The places that keyframes recognise.
struct Recognitions {
  std::vector<PoseEdge> sure;      ///< those that are certain by themselves
  std::vector<PoseEdge> possible;  ///< all
};

/// Joins maps with the first one.
class MapMerger {
 public:
  MapMerger(MapContent first, const KeyframeSpacing& spacing, const LoopOptions& loops,
            const RegistrationOptions& registration)
      : content_(std::move(first)),
        spacing_(spacing),
        loops_(loops),
        registration_(registration),
        map_(largest_map(content_)) {
    content_.keyframes.settle_maps();
  }

  /// Joins a map if its places are recognised. Tells how near it came.
  bool join(const MapContent& added, const std::function<void()>& tell, MapNearness& nearness);

  const MapContent& content() const { return content_; }

  /// The first keyframe of the joined maps.
  const Keyframe& first() const {
    return *std::ranges::find(content_.keyframes.all(), map_, &Keyframe::map);
  }

  /// Moves the joined maps so that a keyframe of them gets this pose.
  void move_to(int keyframe, const Pose& world_from_camera);

  MapContent take();

 private:
  Recognitions recognise_in(std::span<const Keyframe> keyframes, int map,
                            const std::function<void()>& tell, MapNearness& nearness) const;
  void close_loops(int first, const std::function<void()>& tell);
  void order_recordings();

  MapContent content_;
  KeyframeSpacing spacing_;
  LoopOptions loops_;
  RegistrationOptions registration_;
  int map_;  ///< the map that others are joined with
};

/// Recognises places of the map so far in those keyframes, of all, that belong to `map`.
Recognitions MapMerger::recognise_in(std::span<const Keyframe> keyframes, int map,
                                     const std::function<void()>& tell,
                                     MapNearness& nearness) const {
  const auto everywhere = [](const Keyframe&, const Pose&) { return true; };
  Recognitions recognitions;
  for (const Keyframe& keyframe : keyframes) {
    if (keyframe.map != map) continue;
    tell();
    std::vector<const Keyframe*> candidates;
    for (const Keyframe& other : keyframes) {
      if (other.map == map_) candidates.push_back(&other);
    }
    const RecognisedPlaces places =
        recognise_places(keyframe, std::move(candidates), everywhere, keyframes, content_.camera,
                         loops_, registration_);
    std::ranges::copy(places.possible, std::back_inserter(recognitions.possible));
    if (places.surest) recognitions.sure.push_back(*places.surest);
    ++nearness.keyframes;
    nearness.recognised += places.surest ? 1 : 0;
  }
  return recognitions;
}

bool MapMerger::join(const MapContent& added, const std::function<void()>& tell,
                     MapNearness& nearness) {
  nearness = {};
  const std::vector<Keyframe> own = renumbered(added, content_);
  std::vector<Keyframe> all(content_.keyframes.all().begin(), content_.keyframes.all().end());
  const int first = content_.keyframes.size();
  const int map = largest_map(added) + maps_begun(content_);
  std::ranges::copy(own, std::back_inserter(all));
  const Recognitions recognitions = recognise_in(all, map, tell, nearness);
  const auto anywhere = [](const MapJoin&) { return true; };
  const JoinContext context{all, content_.camera, spacing_, loops_, registration_};
  auto [join, agreeing, obstacle] =
      choose_join(map, recognitions.sure, recognitions.possible, anywhere, context);
  nearness.agreeing = agreeing;
  // No more keyframes will come: three that agree are enough.
  if (!join) join = find_certain_join(map, recognitions.possible, anywhere, context);
  nearness.obstacle = join ? JoinObstacle::none : obstacle;
  if (!join) return false;
  append_rest(added, own, content_);
  content_.keyframes.join(map, map_, join->into_from_map);
  for (const PoseEdge& edge : join->edges) add_loop(content_, edge);
  fit_map(content_, loops_);
  close_loops(first, tell);
  return true;
}

void MapMerger::move_to(int keyframe, const Pose& world_from_camera) {
  const Pose before = content_.keyframes[keyframe].world_from_camera;
  content_.keyframes.join(map_, map_, world_from_camera * before.inverse());
}

/// Searches loops between the keyframes from `first` on and those before.
void MapMerger::close_loops(int first, const std::function<void()>& tell) {
  if (!loops_.close) return;
  for (int id = first; id < content_.keyframes.size(); ++id) {
    const Keyframe& keyframe = content_.keyframes[id];
    if (keyframe.map != map_) continue;
    tell();
    const LoopCandidate loop =
        find_loop(keyframe, content_.keyframes.all(), content_.keyframes.spreads_from(id),
                  content_.camera, loops_, registration_);
    if (loop.edge && !loop.needs_slip && loop.from < first) add_loop(content_, *loop.edge);
  }
  fit_map(content_, loops_);
}

/// Puts the recordings in the order of their dates.
void MapMerger::order_recordings() {
  std::vector<std::size_t> order(content_.recordings.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return content_.recordings[i].added; });
  std::vector<MapRecording> ordered;
  std::vector<int> place(order.size());
  for (const std::size_t i : order) {
    place[i] = static_cast<int>(ordered.size());
    ordered.push_back(content_.recordings[i]);
    ordered.back().verdict.clear();  // it was on another map
  }
  content_.recordings = std::move(ordered);
  content_.keyframes.renumber_recordings(place);
  for (RegisteredFrame& frame : content_.frames) {
    frame.recording = place[static_cast<std::size_t>(frame.recording)];
  }
  std::ranges::stable_sort(content_.frames, {}, &RegisteredFrame::recording);
}

MapContent MapMerger::take() {
  order_recordings();
  content_.changes = find_changes(content_);
  return std::move(content_);
}

using Members = std::vector<std::size_t>;

/// Maps that were joined with each other.
struct Group {
  MapMerger merger;
  Members members;  ///< indices of the maps; the first one has the world of the group

  bool join(Group& added, const std::function<void()>& tell, MapNearness& nearness);
};

/// Joins another group, which must not be used afterwards, if places are recognised: by its
/// keyframes or, since places that look alike may be closer to the one than to the other, by those
/// of this group.
bool Group::join(Group& added, const std::function<void()>& tell, MapNearness& nearness) {
  if (merger.content().keyframes.size() == 0) return false;  // of a run that was interrupted early
  if (!merger.join(added.merger.content(), tell, nearness)) {
    const int first = added.merger.content().keyframes.size() + merger.first().id;
    const Pose world_from_first = merger.first().world_from_camera;
    MapNearness reverse;
    if (!added.merger.join(merger.content(), tell, reverse)) return false;
    nearness = reverse;
    merger = std::move(added.merger);
    merger.move_to(first, world_from_first);
  }
  std::ranges::copy(added.members, std::back_inserter(members));
  return true;
}

/// Throws UsageError if maps cannot be merged.
void check_maps(const std::vector<MapContent>& maps) {
  if (maps.empty()) throw UsageError("there is no map to merge");
  const MapContent& first = maps.front();
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const MapContent& map = maps[i];
    if (!are_same_camera(first.camera, map.camera)) {
      throw UsageError(fmt::format(
          "map {} was made with another camera than the first one; only maps of one camera can be "
          "merged",
          i + 1));
    }
    if (!(first.surface_options == map.surface_options)) {
      throw UsageError(fmt::format(
          "map {} has other options 'map.…' than the first one, such as voxels of {} instead of {} "
          "m; make both with the same options",
          i + 1, map.surface_options.voxel_m, first.surface_options.voxel_m));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!have_one_recording(map, maps[j])) continue;
      throw UsageError(
          fmt::format("maps {} and {} have a recording in common, which would count twice; give "
                      "one of them only",
                      j + 1, i + 1));
    }
  }
}

}  // namespace

MergedMaps merge_maps(std::vector<MapContent> maps, const KeyframeSpacing& spacing,
                      const LoopOptions& loops, const RegistrationOptions& registration,
                      const std::function<void(std::size_t map)>& tell) {
  check_maps(maps);
  std::vector<MapNearness> nearness(maps.size());
  std::vector<Group> groups;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    groups.push_back({MapMerger(std::move(maps[i]), spacing, loops, registration), {i}});
  }
  std::set<std::pair<Members, Members>> tried;
  const auto join = [&](Group& group, Group& added) {
    if (!tried.emplace(group.members, added.members).second) return false;
    const auto tell_of_map = [&] {
      if (tell) tell(added.members.front());
    };
    MapNearness found;
    const bool is_joined = group.join(added, tell_of_map, found);
    if (&group == &groups.front()) {
      for (const std::size_t i : added.members) nearness[i] = found;
    }
    return is_joined;
  };
  const auto grow = [&](Group& group) {
    for (auto added = groups.begin() + (&group - groups.data()) + 1; added < groups.end();) {
      if (join(group, *added)) {
        groups.erase(added);
        return true;
      }
      ++added;
    }
    return false;
  };
  // Only if nothing fits the first ones, others are joined with each other.
  while (std::ranges::any_of(groups, grow)) continue;
  MergedMaps merged{groups.front().merger.take(), std::move(nearness), {}};
  merged.is_joined.resize(merged.nearness.size(), false);
  for (const std::size_t i : groups.front().members) merged.is_joined[i] = true;
  return merged;
}

}  // namespace tofmap

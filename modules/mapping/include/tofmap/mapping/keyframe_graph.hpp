// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/pose_spread.hpp>

namespace tofmap {

/// The distance between keyframes, in translation and in rotation. Both must be positive.
struct KeyframeSpacing {
  double step_m = 0;
  double rotation_rad = 0;

  /// The distance of two cameras in units of this spacing: by translation or by rotation, whichever
  /// is larger.
  double between(const Pose& a, const Pose& b) const;
};

/// The connection of a keyframe with another one.
struct KeyframeLink {
  int to = 0;
  PoseSpread spread;
  std::optional<PoseSpread> registered;  ///< `spread` without loops; empty if only by a loop

  bool operator==(const KeyframeLink&) const = default;
};

/// The keyframes of a run, and which of them were registered with each other. Keyframes that were
/// registered with each other have correct relative poses, up to the spread of that registration,
/// however far the path drifted between them. The spread is large where both saw little but a bare
/// wall.
class KeyframeGraph {
 public:
  KeyframeGraph() = default;  ///< keeps the clouds of keyframes as they are
  /// Keeps the clouds of keyframes, which this camera took, on a CloudShelf.
  explicit KeyframeGraph(const CameraModel& camera) : shelf_(CloudShelf(camera)) {}

  /// Adds a keyframe, whose id must be size().
  void add(Keyframe keyframe);

  /// Adds a keyframe whose cloud is read when it is needed. The graph must have a camera.
  void add(Keyframe keyframe, std::function<CompactCloud()> read_cloud);

  /// Records that two keyframes were registered with each other with this spread of their relative
  /// pose, and that their poses agree with the result. If that is not the first time, the smaller
  /// spread is kept.
  void connect(int a, int b, const PoseSpread& spread);

  /// Records that a loop connects two keyframes with this spread, until forget_loops().
  void connect_by_loop(int a, int b, const PoseSpread& spread);

  /// Forgets the connections by loops, and what reconnect() has derived from them.
  void forget_loops();

  int size() const { return static_cast<int>(keyframes_.size()); }
  const Keyframe& operator[](int id) const { return keyframes_[static_cast<std::size_t>(id)]; }
  std::span<const Keyframe> all() const { return keyframes_; }

  /// The connections of a keyframe, in the order in which they came about.
  std::span<const KeyframeLink> links(int id) const { return links_[static_cast<std::size_t>(id)]; }

  /// Replaces the connections of a keyframe by those that links() returned.
  void set_links(int id, std::vector<KeyframeLink> links);

  /// Sets the pose of a keyframe.
  void set_pose(int id, const Pose& world_from_camera);

  /// Replaces the cloud of a keyframe, and with it the descriptor of its place.
  void set_cloud(int id, const KeyframeCloud& cloud);

  /// Keeps no more than the cloud expanded that was used last. That saves memory, and costs no time
  /// where each cloud is used once.
  void keep_clouds_compact();

  /// Moves all keyframes of a map into another one.
  void join(int map, int into, const Pose& into_from_map);

  /// Assigns keyframes to maps anew, by the map that they were taken in: `map_of[taken_in]`.
  /// Keyframes of different maps are no longer connected.
  void assign_maps(std::span<const int> map_of);

  /// Makes all joins of maps final: keyframes count as taken in the map that they belong to.
  void settle_maps();

  /// Gives recordings other numbers: `number_of[recording]`.
  void renumber_recordings(std::span<const int> number_of);

  /// Removes the newest keyframes, those with an id of at least `size`. None of the others may be
  /// connected with one of them.
  void shrink(int size);

  /// At most `count` keyframes around a pose: keyframe `id`, and those nearest to the pose among
  /// its well-connected keyframes. Keyframe `id` comes last, the others come in the order of
  /// their ids. `steps` is the unit of distance. The pointers are valid until a keyframe is added.
  std::vector<const Keyframe*> around(int id, const Pose& pose, int count,
                                      const KeyframeSpacing& steps) const;

  /// The spreads of the keyframes that are well connected with a keyframe, by their ids: at most
  /// five registrations connect both, and these add up to at most `well_connected_sigma_m` of
  /// spread in translation. The keyframe itself has a spread of 0.
  std::map<int, PoseSpread> well_connected_to(int id) const;

  /// For each keyframe, the spread of its pose relative to keyframe `id`, along the connections
  /// that give the smallest spread in translation. Empty for a keyframe that has no connection with
  /// `id`, or one with a larger standard deviation than `most_sigma_m`.
  std::vector<std::optional<PoseSpread>> spreads_from(
      int id, double most_sigma_m = std::numeric_limits<double>::infinity()) const;

  /// Reduces the spread of keyframes whose registration with each other did not constrain all
  /// directions, if a path over other keyframes now connects them with a spread of at most
  /// `well_connected_sigma_m`, as after a loop.
  void reconnect();

  /// Standard deviation of a relative pose up to which a frame can be registered with both
  /// keyframes at once: what registration tolerates where surfaces do not coincide.
  static constexpr double well_connected_sigma_m = 0.03;

 private:
  KeyframeCloud kept(const KeyframeCloud& cloud);

  KeyframeLink& link(int of, int to);

  std::optional<CloudShelf> shelf_;  ///< empty: clouds are kept as they are
  std::vector<Keyframe> keyframes_;
  std::vector<std::vector<KeyframeLink>> links_;  ///< for each keyframe, those to others
};

}  // namespace tofmap

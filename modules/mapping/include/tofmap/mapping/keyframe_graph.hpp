// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/pose_spread.hpp>

namespace boost::serialization {
class access;
}

namespace tofmap {

/// The distance between keyframes, in translation and in rotation. Both must be positive.
struct KeyframeSpacing {
  double step_m = 0;
  double rotation_rad = 0;

  /// The distance of two cameras in units of this spacing: by translation or by rotation, whichever
  /// is larger.
  double between(const Pose& a, const Pose& b) const;
};

/// The keyframes of a run, and which of them were registered with each other. Keyframes that were
/// registered with each other have correct relative poses, up to the spread of that registration,
/// however far the path drifted between them. The spread is large where both saw little but a bare
/// wall.
class KeyframeGraph {
 public:
  /// Adds a keyframe, whose id must be size().
  void add(Keyframe keyframe);

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

  /// Sets the pose of a keyframe.
  void set_pose(int id, const Pose& world_from_camera);

  /// Replaces the cloud of a keyframe, and with it the descriptor of its place.
  void set_cloud(int id, std::shared_ptr<const SurfaceCloud> cloud);

  /// Moves all keyframes of a map into another one.
  void join(int map, int into, const Pose& into_from_map);

  /// Assigns keyframes to maps anew, by the map that they were taken in: `map_of[taken_in]`.
  /// Keyframes of different maps are no longer connected.
  void assign_maps(std::span<const int> map_of);

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
  friend class boost::serialization::access;
  template <class Archive>
  void serialize(Archive& archive, unsigned version);  // mapper_archive.cpp

  /// A keyframe that another one is connected with.
  struct Neighbour {
    int id = 0;
    PoseSpread spread;
    std::optional<PoseSpread> registered;  ///< `spread` without loops; empty if only by a loop

    template <class Archive>
    void serialize(Archive& archive, unsigned version);
  };

  Neighbour& neighbour(int of, int id);

  std::vector<Keyframe> keyframes_;
  std::vector<std::vector<Neighbour>> neighbours_;  ///< for each keyframe, those connected with it
};

}  // namespace tofmap

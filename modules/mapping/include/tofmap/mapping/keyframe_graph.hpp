// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/mapping/keyframe.hpp>

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
/// registered with each other have correct relative poses, however far the path drifted between
/// them.
class KeyframeGraph {
 public:
  /// Adds a keyframe, whose id must be size().
  void add(Keyframe keyframe);

  /// Records that two keyframes were registered with each other, and that their poses agree with
  /// the result.
  void connect(int a, int b);

  int size() const { return static_cast<int>(keyframes_.size()); }
  const Keyframe& operator[](int id) const { return keyframes_[static_cast<std::size_t>(id)]; }
  std::span<const Keyframe> all() const { return keyframes_; }

  /// Sets the pose of a keyframe.
  void set_pose(int id, const Pose& world_from_camera);

  /// Replaces the cloud of a keyframe, and with it the descriptor of its place.
  void set_cloud(int id, std::shared_ptr<const SurfaceCloud> cloud);

  /// Moves all keyframes of a map into another one.
  void join(int map, int into, const Pose& into_from_map);

  /// Removes the newest keyframes, those with an id of at least `size`. None of the others may be
  /// connected with one of them.
  void shrink(int size);

  /// At most `count` keyframes around a pose: keyframe `id`, and those nearest to the pose among
  /// the keyframes that at most five registrations connect with `id`. Keyframe `id` comes last, the
  /// others come in the order of their ids. `steps` is the unit of distance. The pointers are valid
  /// until a keyframe is added.
  std::vector<const Keyframe*> around(int id, const Pose& pose, int count,
                                      const KeyframeSpacing& steps) const;

 private:
  friend class boost::serialization::access;
  template <class Archive>
  void serialize(Archive& archive, unsigned version);  // mapper_archive.cpp

  /// Ids of the keyframes that at most five registrations connect with `id`, without `id`.
  std::vector<int> within_reach(int id) const;

  std::vector<Keyframe> keyframes_;
  std::vector<std::vector<int>> neighbours_;  ///< for each keyframe, those registered with it
};

}  // namespace tofmap

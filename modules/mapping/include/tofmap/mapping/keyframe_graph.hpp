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

/// The steps at which keyframes are taken.
struct KeyframeSpacing {
  double step_m = 0;
  double rotation_rad = 0;

  /// How many steps apart two cameras are: by distance or by turn, the larger of both.
  double between(const Pose& a, const Pose& b) const;
};

/// The keyframes of a run, and which of them have been registered with each other: those are where
/// they should be relative to one another, however far the path has drifted between them.
class KeyframeGraph {
 public:
  /// Ids count from 0.
  void add(Keyframe keyframe);

  /// Both have been registered with each other, and their poses agree with that.
  void tie(int a, int b);

  int size() const { return static_cast<int>(keyframes_.size()); }
  const Keyframe& operator[](int id) const { return keyframes_[static_cast<std::size_t>(id)]; }
  std::span<const Keyframe> all() const { return keyframes_; }

  /// Moves a keyframe.
  void place(int id, const Pose& world_from_camera);

  /// The keyframes around a pose, at most `count`, among those that few ties lie between and `id`:
  /// those the fewest steps away. `id` is one of them and comes last, the others in the order of
  /// their ids.
  std::vector<const Keyframe*> around(int id, const Pose& pose, int count,
                                      const KeyframeSpacing& steps) const;

 private:
  friend class boost::serialization::access;
  template <class Archive>
  void serialize(Archive& archive, unsigned version);  // mapper_archive.cpp

  /// Ids that at most so many ties lie between and `id`, without it.
  std::vector<int> within_reach(int id) const;

  std::vector<Keyframe> keyframes_;
  std::vector<std::vector<int>> tied_;  ///< to each keyframe
};

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <tofmap/mapping/map_content.hpp>
#include <tofmap/visualization/drawing.hpp>

namespace tofmap::app {

/// What a map file tells beyond the surface: its keyframes, one of which is shown at a time, and
/// what has changed between its recordings.
class MapDetails {
 public:
  explicit MapDetails(MapContent content);

  const MapContent& content() const { return content_; }
  /// Number of the map that is shown (Keyframe::map).
  int map() const { return map_; }

  /// Shows the next keyframe of the map, or the one before (`step` −1). The first one is shown
  /// after none. If no keyframe is shown, none is added by add_keyframe().
  void step(int step);

  /// Shows a keyframe. Throws UsageError if the map has none of this id.
  void show(int id);

  /// Adds the points and the field of view of the keyframe that is shown.
  void add_keyframe(Drawing& drawing, const Pose& drawing_from_world) const;

  /// Adds what has changed: gone in red, new in green, moved in blue.
  void add_changes(Drawing& drawing, const Pose& drawing_from_world) const;

  bool has_changes() const { return !content_.changes.empty(); }

  /// Which keyframe is shown, from which recording. Empty if none is.
  std::string status() const;

 private:
  MapContent content_;
  int map_ = 0;
  int shown_ = -1;  ///< id of a keyframe; −1: none
};

}  // namespace tofmap::app

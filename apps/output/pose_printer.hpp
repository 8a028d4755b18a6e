// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <span>

#include <tofmap/mapping/map_content.hpp>

namespace tofmap::app {

/// Prints the poses of a camera in a finished map as soon as they are known, for programs that
/// follow the camera while it moves.
class PosePrinter {
 public:
  /// From here on, the program is not ended by a reader of stdout that goes away.
  PosePrinter();

  /// Prints those of the frames that were not printed before, each as a line of a trajectory
  /// (write_pose()), on stdout. `localised` are localised_frames_of() a map with these keyframes:
  /// frames from before the camera was found, or while it was lost, come all at once afterwards.
  /// Returns false if nobody reads stdout any more.
  bool print_new(std::span<const RegisteredFrame* const> localised, const KeyframeGraph& keyframes);

 private:
  std::set<int> printed_;  ///< indices of frames
};

}  // namespace tofmap::app

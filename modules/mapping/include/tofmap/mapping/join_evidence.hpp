// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

namespace tofmap {

/// What the keyframes of a map tell about its join with another one. Places of one plan look alike,
/// but differ in what was put there.
struct JoinEvidence {
  int compared = 0;   ///< number of keyframes that see what the other map sees
  int differing = 0;  ///< number of those that differ from it

  /// Adds a keyframe: whether it differs. Empty if it sees nothing of what the other map sees.
  void add(std::optional<bool> differs);

  /// Whether the maps do not belong together: at least two keyframes differ (a single one may be
  /// wrong) and, if things may have been moved between the two maps, more than half of them.
  bool refutes(bool things_may_have_moved) const;
};

}  // namespace tofmap

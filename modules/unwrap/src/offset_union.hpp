// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>
#include <utility>
#include <vector>

namespace tofmap {

/// Disjoint sets whose members know their integer offset to one another: the union-find of a
/// spanning forest, where each edge tells a difference of counts.
class OffsetUnion {
 public:
  explicit OffsetUnion(int size) : parent_(size), to_parent_(size, 0), size_(size, 1) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  struct Place {
    int root;
    int offset;  ///< count(member) − count(root)
  };

  Place find(int member) {
    int root = member;
    int offset = 0;
    while (parent_[root] != root) {
      offset += to_parent_[root];
      root = parent_[root];
    }
    // Point the whole path at the root, so that later calls are short.
    for (int remaining = offset; parent_[member] != member;) {
      const int next = std::exchange(parent_[member], root);
      const int step = std::exchange(to_parent_[member], remaining);
      remaining -= step;
      member = next;
    }
    return {root, offset};
  }

  /// Hangs the set of `child_root` under `root`: count(child_root) = count(root) + offset.
  void join(int root, int child_root, int offset) {
    parent_[child_root] = root;
    to_parent_[child_root] = offset;
    size_[root] += size_[child_root];
  }

  /// Members of the set with this root.
  int size(int root) const { return size_[root]; }

 private:
  std::vector<int> parent_;
  std::vector<int> to_parent_;
  std::vector<int> size_;  ///< of roots
};

}  // namespace tofmap

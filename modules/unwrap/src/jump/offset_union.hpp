// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace tofmap {

/// Disjoint sets whose members know their integer offset to one another: the union-find of a
/// spanning forest, where each edge tells a difference of counts.
class OffsetUnion {
 public:
  explicit OffsetUnion(int size) : members_(static_cast<std::size_t>(size)) {
    for (int i = 0; i < size; ++i) member(i).parent = i;
  }

  struct Place {
    int root;
    int offset;  ///< count(member) − count(root)
  };

  Place find(int number) {
    Member* at = &member(number);
    // Paths are halved on the way: who points at a member points at the one beyond it afterwards.
    int offset = 0;
    while (member(at->parent).parent != at->parent) {
      const Member& next = member(at->parent);
      at->to_parent += next.to_parent;
      at->parent = next.parent;
      offset += at->to_parent;
      at = &member(at->parent);
    }
    return {at->parent, offset + at->to_parent};
  }

  /// Makes every member point at its root.
  void flatten() {
    for (Member& at : members_) {
      // Members come after their parents more often than not; those are flat then.
      const Place place = find(at.parent);
      at.to_parent += place.offset;
      at.parent = place.root;
    }
  }

  /// What a member points at: its root, if no set has been joined since the last flatten().
  int parent(int number) const { return members_[static_cast<std::size_t>(number)].parent; }

  /// Hangs the set of `child_root` under `root`: count(child_root) = count(root) + offset.
  void join(int root, int child_root, int offset) {
    member(child_root).parent = root;
    member(child_root).to_parent = offset;
    member(root).size += member(child_root).size;
  }

  /// Members of the set with this root.
  int size(int root) const { return members_[static_cast<std::size_t>(root)].size; }

 private:
  struct Member {
    int parent = 0;
    int to_parent = 0;  ///< count(member) − count(parent)
    int size = 1;       ///< of the set, if this is a root
  };

  Member& member(int number) { return members_[static_cast<std::size_t>(number)]; }

  std::vector<Member> members_;
};

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace tofmap {

/// Union-find over a spanning forest in which each edge is a difference of wrap counts: the members
/// of a set know their integer offsets from the root.
class OffsetUnion {
 public:
  explicit OffsetUnion(int size) : members_(static_cast<std::size_t>(size)) {
    for (int i = 0; i < size; ++i) member(i).parent = i;
  }

  struct Place {
    int root;
    int offset;  ///< count(member) − count(root)
  };

  /// The root of a member's set and the member's offset from it. Shortens the paths that it
  /// follows.
  Place find(int number) {
    Member* at = &member(number);
    // Path halving: every other member on the path is made to point at its grandparent.
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
      // Most members have a higher number than their parent, which then points at its root already.
      const Place place = find(at.parent);
      at.to_parent += place.offset;
      at.parent = place.root;
    }
  }

  /// The parent of a member; this is its root if no sets have been joined since the last flatten().
  int parent(int number) const { return members_[static_cast<std::size_t>(number)].parent; }

  /// Joins the set of `child_root` to that of `root`, with count(child_root) = count(root) +
  /// offset.
  void join(int root, int child_root, int offset) {
    member(child_root).parent = root;
    member(child_root).to_parent = offset;
    member(root).size += member(child_root).size;
  }

  /// The number of members of the set with this root.
  int size(int root) const { return members_[static_cast<std::size_t>(root)].size; }

 private:
  struct Member {
    int parent = 0;
    int to_parent = 0;  ///< count(member) − count(parent)
    int size = 1;       ///< size of the set if this is a root
  };

  Member& member(int number) { return members_[static_cast<std::size_t>(number)]; }

  std::vector<Member> members_;
};

}  // namespace tofmap

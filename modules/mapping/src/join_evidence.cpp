// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/join_evidence.hpp"

namespace tofmap {

void JoinEvidence::add(std::optional<bool> differs) {
  compared += differs ? 1 : 0;
  differing += differs.value_or(false) ? 1 : 0;
}

bool JoinEvidence::refutes(bool things_may_have_moved) const {
  constexpr int least_differing = 2;
  if (differing < least_differing) return false;
  return !things_may_have_moved || 2 * differing > compared;
}

}  // namespace tofmap

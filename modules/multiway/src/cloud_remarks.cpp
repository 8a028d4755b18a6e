// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cloud_remarks.hpp"

#include <sstream>
#include <utility>

namespace tofmap {
namespace {

std::string rounded(double value) {
  constexpr int digits = 4;
  std::ostringstream text;
  text.precision(digits);
  text << value;
  return text.str();
}

std::pair<bool, int> nearness(const CloudPair& pair) {
  return {pair.verdict == PairVerdict::registered, pair.support};
}

}  // namespace

std::string why_not_registered(int cloud, const std::vector<CloudPair>& pairs,
                               std::span<const std::string> names) {
  const CloudPair* best = nullptr;
  for (const CloudPair& pair : pairs) {
    if (pair.source != cloud && pair.target != cloud) continue;
    if (best == nullptr || nearness(pair) > nearness(*best)) best = &pair;
  }
  if (best == nullptr) return {};
  const int other = best->source == cloud ? best->target : best->source;
  const std::string& name = names[static_cast<std::size_t>(other)];
  if (best->verdict == PairVerdict::registered) {
    return "fits " + name + ", but neither of the two fits the other clouds";
  }
  return "fits no other cloud; the best match is " + name + " (" +
         std::string(name_of(best->verdict)) + ")";
}

std::string odd_size(double ratio) {
  return "its size differs from that of the others by a factor of " + rounded(ratio) +
         ", and it fits none of them in any common unit; does it show the same place, in metres?";
}

std::string other_unit(const LengthUnit& unit, const std::string& name_of_fitting) {
  return "seems to be in another unit (" + unit.name + "): scaled by " + rounded(unit.length) +
         ", it fits " + name_of_fitting;
}

std::string too_fine(double voxel_m, double least_m) {
  return "register.voxel_m: " + rounded(voxel_m) +
         " m is too small for clouds of this extent; allowed: 0 (automatic), or at least " +
         rounded(least_m) + " m";
}

}  // namespace tofmap

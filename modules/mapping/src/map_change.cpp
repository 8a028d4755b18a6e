// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/map_change.hpp"

#include <array>

namespace tofmap {
namespace {

constexpr std::array<NamedValue<ChangeKind>, 3> kind_names{
    {{"gone", ChangeKind::gone}, {"new", ChangeKind::appeared}, {"moved", ChangeKind::moved}}};

}  // namespace

std::span<const NamedValue<ChangeKind>> named_values(ChangeKind /*kind*/) { return kind_names; }

Eigen::AlignedBox3f box_of(const MapCloud& cloud) {
  Eigen::AlignedBox3f box;
  for (const MapPoint& point : cloud) box.extend(Eigen::Vector3f(point.getVector3fMap()));
  return box;
}

std::size_t point_count(const MapChange& change) {
  return change.before.size() + change.after.size();
}

double moved_m(const MapChange& change) {
  const Eigen::Vector3d middle_m = box_of(change.before).center().cast<double>();
  return (change.after_from_before * middle_m - middle_m).norm();
}

}  // namespace tofmap

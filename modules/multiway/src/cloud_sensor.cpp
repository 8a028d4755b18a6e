// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/multiway/cloud_sensor.hpp"

#include <array>

#include <tofmap/registration/scan_pattern.hpp>

namespace tofmap {
namespace {

const Eigen::Vector3d origin = Eigen::Vector3d::Zero();

}  // namespace

std::span<const NamedValue<SensorAtOrigin>> named_values(SensorAtOrigin) {
  static constexpr std::array<NamedValue<SensorAtOrigin>, 3> values{
      {{"infer", SensorAtOrigin::infer}, {"yes", SensorAtOrigin::yes}, {"no", SensorAtOrigin::no}}};
  return values;
}

std::span<const NamedValue<SensorSource>> named_values(SensorSource) {
  static constexpr std::array<NamedValue<SensorSource>, 5> values{
      {{"unknown", SensorSource::unknown},
       {"given", SensorSource::given},
       {"stated", SensorSource::stated},
       {"inferred", SensorSource::inferred},
       {"range_limit", SensorSource::range_limit}}};
  return values;
}

void leave_out_range_limit(PointSet& cloud, SensorAtOrigin at_origin) {
  const bool is_origin = at_origin == SensorAtOrigin::yes;
  if (!is_origin && cloud.viewpoint) {
    cloud.limit = find_range_limit(cloud.points, *cloud.viewpoint);
  }
  if (!cloud.limit) cloud.limit = find_range_limit(cloud.points, origin);
  if (!is_origin && !cloud.limit) cloud.limit = find_range_limit(cloud.points);
  if (cloud.limit) remove_range_limit(cloud.points, *cloud.limit);
}

CloudSensor find_sensor(const PointSet& cloud, SensorAtOrigin at_origin) {
  if (at_origin == SensorAtOrigin::yes) return {SensorSource::given, origin};
  if (cloud.limit) return {SensorSource::range_limit, cloud.limit->sensor};
  if (cloud.viewpoint && !scan_pattern(cloud.points, *cloud.viewpoint).is_evidence_against()) {
    return {SensorSource::stated, cloud.viewpoint};
  }
  if (at_origin == SensorAtOrigin::infer && scan_pattern(cloud.points, origin).is_evidence_for()) {
    return {SensorSource::inferred, origin};
  }
  return {};
}

}  // namespace tofmap

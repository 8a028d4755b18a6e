// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <tofmap/cloud/point_file.hpp>
#include <tofmap/core/named_value.hpp>

namespace tofmap {

/// Whether clouds are in the frames of their sensors, so that the origin is the sensor's position.
enum class SensorAtOrigin {
  infer,  ///< decided for each cloud by the pattern of its points, see find_sensor()
  yes,    ///< the origin of each cloud is the position of its sensor
  no,     ///< the origin of no cloud is the position of its sensor
};

std::span<const NamedValue<SensorAtOrigin>> named_values(SensorAtOrigin);

/// How the position of a cloud's sensor is known.
enum class SensorSource {
  unknown,      ///< it is not known: the cloud was moved, merged, or has too little structure
  given,        ///< the options say that it is the origin
  stated,       ///< the file states it
  inferred,     ///< the points form the pattern of a single scan about the origin
  range_limit,  ///< it is the centre of points at the limit of the sensor's range
};

std::span<const NamedValue<SensorSource>> named_values(SensorSource);

/// The position of a cloud's sensor, in the frame and the unit of the cloud.
struct CloudSensor {
  SensorSource source = SensorSource::unknown;
  std::optional<Eigen::Vector3d> position;  ///< empty if unknown
};

/// Removes points at a limit of the sensor's range from a cloud, and records the limit as
/// `cloud.limit` (find_range_limit()). With `yes`, the limit is about the origin; otherwise it is
/// about the viewpoint of the file, about the origin, or, if neither has such points, about any
/// place. Does nothing if there are no such points.
void leave_out_range_limit(PointSet& cloud, SensorAtOrigin at_origin);

/// Finds the position of a cloud's sensor. With `yes`, it is the origin. Otherwise it is the centre
/// of `cloud.limit`, or, without one, the viewpoint that the file states, unless the points show
/// that they were not recorded from there (scan_pattern()). If there is neither, `infer` takes the
/// origin if the pattern of the points is evidence for it. Otherwise the position is unknown.
CloudSensor find_sensor(const PointSet& cloud, SensorAtOrigin at_origin);

}  // namespace tofmap

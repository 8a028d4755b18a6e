// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Writes the plain types of mapping as JSON, and reads them again to the bit. Readers trust
// nothing: they throw InputError if a value is missing, of another type, or not plausible.

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {

using Json = nlohmann::json;

/// Larger numbers are damage: of metres, radians, seconds, covariances and their inverses.
constexpr double largest_number = 1e18;

/// The member of an object.
inline const Json& member(const Json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  if (!object.is_object() || found == object.end()) {
    throw InputError(std::string("'") + name + "' is missing");
  }
  return *found;
}

inline double number_in(const Json& value) {
  if (!value.is_number()) throw InputError("a number is missing");
  const auto number = value.get<double>();
  if (!(std::abs(number) <= largest_number)) throw InputError("a number is not plausible");
  return number;
}

inline double number_in(const Json& object, const char* name) {
  return naming(name, [&] { return number_in(member(object, name)); });
}

/// An integer from `least` to `most`.
inline int integer_in(const Json& object, const char* name, int least,
                      int most = std::numeric_limits<int>::max()) {
  const Json& value = member(object, name);
  if (!value.is_number_integer() || value.get<std::int64_t>() < least ||
      value.get<std::int64_t>() > most) {
    throw InputError(std::string("'") + name + "' is not a number from " + std::to_string(least) +
                     " to " + std::to_string(most));
  }
  return static_cast<int>(value.get<std::int64_t>());
}

inline bool flag_in(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_boolean()) throw InputError(std::string("'") + name + "' is not true or false");
  return value.get<bool>();
}

inline const Json& list_in(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_array()) throw InputError(std::string("'") + name + "' is not a list");
  return value;
}

/// By column.
template <int rows, int cols>
Json json_of(const Eigen::Matrix<double, rows, cols>& matrix) {
  return Json(std::vector<double>(matrix.data(), matrix.data() + matrix.size()));
}

template <class Matrix>
Matrix matrix_in(const Json& object, const char* name) {
  const Json& value = list_in(object, name);
  Matrix matrix;
  if (value.size() != static_cast<std::size_t>(matrix.size())) {
    throw InputError(std::string("'") + name + "' has another size");
  }
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    matrix.data()[i] = number_in(value[static_cast<std::size_t>(i)]);
  }
  return matrix;
}

inline Json json_of(const Pose& pose) {
  return {{"rotation", json_of<3, 3>(pose.linear())},
          {"translation_m", json_of<3, 1>(pose.translation())}};
}

/// Throws InputError unless a matrix rotates, up to rounding.
inline void check_rotation(const Eigen::Matrix3d& rotation) {
  constexpr double rounding = 1e-6;
  const Eigen::Matrix3d identity = rotation * rotation.transpose();
  if (!identity.isIdentity(rounding) || !(rotation.determinant() > 0)) {
    throw InputError("a rotation is invalid");
  }
}

inline Pose pose_in(const Json& object, const char* name) {
  const Json& value = member(object, name);
  Pose pose = Pose::Identity();
  pose.linear() = matrix_in<Eigen::Matrix3d>(value, "rotation");
  pose.translation() = matrix_in<Eigen::Vector3d>(value, "translation_m");
  check_rotation(pose.linear());
  return pose;
}

inline Json json_of(const StampedPose& stamped) {
  return {{"timestamp_s", stamped.timestamp_s}, {"pose", json_of(stamped.world_from_camera)}};
}

inline StampedPose stamped_pose_in(const Json& object) {
  return {number_in(object, "timestamp_s"), pose_in(object, "pose")};
}

inline Json json_of(const PoseEdge& edge) {
  return {{"from", edge.from},
          {"to", edge.to},
          {"from_from_to", json_of(edge.from_from_to)},
          {"covariance", json_of<6, 6>(edge.covariance)},
          {"may_be_wrong", edge.may_be_wrong}};
}

/// Throws InputError unless a matrix can be the covariance of a pose: symmetric and positive
/// definite, of variances that numbers can be computed with.
void check_covariance(const Eigen::Matrix<double, 6, 6>& covariance);

/// An edge between two of this many poses.
inline PoseEdge edge_in(const Json& object, int poses) {
  PoseEdge edge;
  edge.from = integer_in(object, "from", 0, poses - 1);
  edge.to = integer_in(object, "to", 0, poses - 1);
  edge.from_from_to = pose_in(object, "from_from_to");
  edge.covariance = matrix_in<Eigen::Matrix<double, 6, 6>>(object, "covariance");
  edge.may_be_wrong = flag_in(object, "may_be_wrong");
  if (edge.from == edge.to) throw InputError("an edge connects a keyframe with itself");
  check_covariance(edge.covariance);
  return edge;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Serialization of the plain types of mapping by Boost.Serialization, exact to the bit. An
// interrupted run is saved and resumed with these functions. Only the same build can read the data.

#include <optional>

#include <boost/serialization/array_wrapper.hpp>
#include <boost/serialization/split_free.hpp>
#include <boost/serialization/vector.hpp>

#include <tofmap/mapping/odometry.hpp>
#include <tofmap/registration/pose_graph.hpp>

namespace boost::serialization {

template <class Archive, class Number, int rows, int cols>
void serialize(Archive& archive, Eigen::Matrix<Number, rows, cols>& matrix, unsigned) {
  static_assert(rows > 0 && cols > 0, "the matrix must have a fixed size");
  archive& make_array(matrix.data(), static_cast<std::size_t>(matrix.size()));
}

template <class Archive, class Value>
void save(Archive& archive, const std::optional<Value>& value, unsigned) {
  archive << value.has_value();
  if (value) archive << *value;
}

template <class Archive, class Value>
void load(Archive& archive, std::optional<Value>& value, unsigned) {
  bool is_there = false;
  archive >> is_there;
  value.reset();
  if (is_there) archive >> value.emplace();
}

template <class Archive, class Value>
void serialize(Archive& archive, std::optional<Value>& value, unsigned version) {
  split_free(archive, value, version);
}

template <class Archive>
void serialize(Archive& archive, tofmap::Pose& pose, unsigned) {
  archive& pose.matrix();
}

template <class Archive>
void serialize(Archive& archive, tofmap::StampedPose& pose, unsigned) {
  archive& pose.timestamp_s& pose.world_from_camera;
}

template <class Archive>
void serialize(Archive& archive, tofmap::PoseEdge& edge, unsigned) {
  archive& edge.from& edge.to& edge.from_from_to& edge.covariance& edge.may_be_wrong;
}

template <class Archive>
void serialize(Archive& archive, tofmap::RegistrationResult& result, unsigned) {
  archive& result.status& result.world_from_camera& result.iterations& result.correspondences;
  archive& result.overlap& result.inlier_ratio& result.rmse_m& result.residual_scale;
  archive& result.covariance& result.target_information;
  archive& result.degenerate_directions& result.direction_shares;
}

template <class Archive>
void serialize(Archive& archive, tofmap::PoseSpread& spread, unsigned) {
  archive& spread.rotation_rad2& spread.translation_m2;
}

template <class Archive>
void serialize(Archive& archive, tofmap::TrackingResult& result, unsigned) {
  archive& result.status& result.world_from_camera& result.is_keyframe& result.targets;
  archive& result.registration& result.target_covariances& result.spread;
}

}  // namespace boost::serialization

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>

#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/loop_closure.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// What a place looks like, in a few numbers: median ranges of the parts of an image.
class PlaceDescriptor {
 public:
  explicit PlaceDescriptor(const SurfaceCloud& cloud);

  /// Mean difference of the logarithms of ranges, over parts that both have; 0 is the same, and it
  /// does not depend on the order. Infinite if they share less than half of the parts.
  double difference(const PlaceDescriptor& other) const;

 private:
  static constexpr std::size_t cols = 11;
  static constexpr std::size_t rows = 9;
  std::array<float, rows * cols> log_range_;  ///< NaN where there is no surface
};

/// Where a camera that was lost is found again.
struct Relocalisation {
  int keyframe = 0;  ///< id of the one it was recognised by
  RegistrationResult registration;
};

/// Finds the camera of a cloud without knowing where to look: the five keyframes whose descriptors
/// (by id) differ least are registered against, each with those before and after it, from where
/// they stand. Of registrations that a loop would be verified by the one that explains most of the
/// cloud is it; nothing if there is none, or if another place explains nearly as much.
std::optional<Relocalisation> relocalise(const SurfaceCloud& cloud,
                                         std::span<const Keyframe> keyframes,
                                         std::span<const PlaceDescriptor> descriptors,
                                         const CameraModel& camera, const LoopOptions& options,
                                         const RegistrationOptions& registration);

}  // namespace tofmap

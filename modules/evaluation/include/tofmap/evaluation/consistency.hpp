// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/core/trajectory.hpp>

/// What tells without any truth whether unwrapping was right. How far each measure can be relied on
/// is stated in docs/evaluation.md.
namespace tofmap {

/// A frame with the ranges that were found for it, of the same size.
struct RangedFrame {
  const DualFrequencyFrame* frame = nullptr;  ///< not null where phases are asked for
  RangeImage image;
  std::optional<Pose> world_from_camera;  ///< if it was placed
};

/// How well both frequencies agree on the wrap counts. NaN if no pixel has both phases.
struct BeatAgreement {
  /// Pixels whose neighbourhood of 5 x 5 would fit the beat better with another wrap count. NaN,
  /// too, if the frequencies tell no counts apart.
  double misfit_percent = 0;
  /// Root mean square difference of phase B from what the range says, in cycles, a pixel by itself.
  double residual_cycles = 0;
};

/// Of images as they come out of unwrapping. Throws UsageError if sizes differ.
BeatAgreement beat_agreement(const std::vector<RangedFrame>& frames, const Modulation& modulation);

/// Pixels with a return whose wrap count the frequencies cannot tell, in images as they come out of
/// unwrapping. NaN without a return.
double ambiguous_percent(const std::vector<RangedFrame>& frames);

/// How far frames that see the same place contradict each other: of the points of one frame that
/// fall on a range of another, those that this one sees through, by more than a tenth of a metre
/// and four standard deviations. Images are those that the map is made of, after filters; every
/// pair of them is looked at. NaN if no frames overlap.
double contradicted_percent(const std::vector<RangedFrame>& frames, const CameraModel& camera);

/// How thick planar surfaces of a map are: over some thousand places of the map that are planar,
/// the median of the root mean square distance of the points within 15 cm, whose normals agree,
/// from their plane. A wall that is there twice is thick. NaN if no place is planar.
double plane_thickness_m(const MapCloud& map);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/diagnostics/ranged_frame.hpp>

/// Measures that tell without ground truth whether unwrapping was right. docs/evaluation.md states
/// how reliable each of them is.
namespace tofmap {

/// How well the wrap counts agree with both frequencies. NaN if no pixel has both phases.
struct ResidualAgreement {
  /// Percentage of pixels whose neighbourhood of 5 x 5 would fit both frequencies better with
  /// another wrap count. Neighbourhoods are left out whose noise hides the difference between wrap
  /// counts: half of it must exceed three standard errors of the mean residual. Also NaN if more
  /// than 99 % are left out, or if the pair of frequencies cannot tell wrap counts apart.
  double misfit_percent = 0;
  /// RMS difference between phase B and what the range from A predicts for it, per pixel.
  double residual_cycles = 0;
};

/// The agreement of the wrap counts of all frames. The images must be as unwrapping returns them,
/// before filters. Throws UsageError if the sizes of a frame and its image differ.
ResidualAgreement residual_agreement(const std::vector<RangedFrame>& frames,
                                     const Modulation& modulation);

/// Percentage of the pixels with a return that are ambiguous: two wrap counts are equally likely,
/// and the pair of frequencies cannot tell them apart. The images must be as unwrapping returns
/// them, before filters. NaN if no pixel has a return.
double ambiguous_percent(const std::vector<RangedFrame>& frames);

/// Percentage of free-space violations between frames. A point of one frame that projects onto a
/// valid range of another frame violates free space if it lies nearer than that range by more than
/// 0.1 m and more than four standard deviations. All pairs of registered frames are compared;
/// points that are hidden behind the other frame's range are not counted. The images must be those
/// after filters. NaN if no frames overlap.
double contradicted_percent(const std::vector<RangedFrame>& frames, const CameraModel& camera);

/// Median thickness of the planar surfaces of a map, metres. The thickness at a point is the RMS
/// distance of the map points within 15 cm, whose normals agree, from their common plane. It is
/// evaluated at about three thousand points. A wall that is mapped twice is thick. NaN if no place
/// is planar.
double plane_thickness_m(const MapCloud& map);

/// All consistency measures of a map. A measure that is unknown is NaN.
struct Consistency {
  double residual_misfit_percent = 0;  ///< ResidualAgreement::misfit_percent
  double residual_rms_cycles = 0;      ///< ResidualAgreement::residual_cycles
  double ambiguous_percent = 0;        ///< ambiguous_percent()
  double contradicted_percent = 0;     ///< contradicted_percent()
  double plane_thickness_m = 0;        ///< plane_thickness_m()
  double view_disagreement_m = 0;      ///< view_disagreement_m()
  /// Mean number of violations of the zero-curl constraint per frame, for methods that estimate
  /// phase jumps.
  double curl_violations_per_frame = 0;
};

/// A Consistency whose measures are all NaN.
Consistency unknown_consistency();

/// How many frames of a camera are enough to judge consistency: 60 if an image has up to 100 000
/// pixels, fewer for larger images, since the frames are kept in memory, and never fewer than 20.
int consistency_frames(const CameraModel& camera);

/// The consistency measures of a map and of some frames that it was made from. `unwrapped` holds
/// the frames with their ranges before filters, `filtered` those with their ranges after filters.
/// curl_violations_per_frame is NaN. Throws UsageError if the sizes of a frame and its image
/// differ.
Consistency consistency_of(const std::vector<RangedFrame>& unwrapped,
                           const std::vector<RangedFrame>& filtered, const MapCloud& map,
                           const SensorModel& sensor);

/// Warnings about measures that exceed the values of correct maps. Empty if none does.
std::vector<std::string> warnings_about(const Consistency& consistency);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/core/trajectory.hpp>

/// Measures that tell without ground truth whether unwrapping was right. docs/evaluation.md states
/// how reliable each of them is.
namespace tofmap {

/// A frame together with ranges that were found for it. Both are of the same size and must outlive
/// this.
struct RangedFrame {
  const DualFrequencyFrame* frame = nullptr;  ///< may be null where no phases are used
  const RangeImage* image = nullptr;          ///< not null
  std::optional<Pose> world_from_camera;      ///< empty if the frame was not registered
};

/// How well the wrap counts agree with both frequencies. NaN if no pixel has both phases.
struct ResidualAgreement {
  /// Pixels whose neighbourhood of 5 x 5 would fit both frequencies better with another wrap count.
  /// NaN, too, if the pair of frequencies tells no counts apart.
  double misfit_percent = 0;
  /// RMS difference between phase B and what the range from A predicts for it, per pixel.
  double residual_cycles = 0;
};

/// The agreement over images as unwrapping returns them, before filters. Throws UsageError if the
/// sizes of a frame and its image differ.
ResidualAgreement residual_agreement(const std::vector<RangedFrame>& frames,
                                     const Modulation& modulation);

/// Pixels with a return whose wrap count the pair of frequencies cannot tell, in images as
/// unwrapping returns them. NaN if no pixel has a return.
double ambiguous_percent(const std::vector<RangedFrame>& frames);

/// Free-space violations between frames: of the points of one frame that project onto a valid range
/// of another, the percentage that lies nearer than that range by more than 0.1 m and four standard
/// deviations. All pairs of frames are compared. Images are those after filters. NaN if no frames
/// overlap.
double contradicted_percent(const std::vector<RangedFrame>& frames, const CameraModel& camera);

/// Median thickness of the planar surfaces of a map: at some thousand planar places, the RMS
/// distance from their plane of the points within 15 cm whose normals agree. A wall that is mapped
/// twice is thick. NaN if no place is planar.
double plane_thickness_m(const MapCloud& map);

/// All of the measures above. NaN where one is unknown.
struct Consistency {
  double residual_misfit_percent = 0;
  double residual_rms_cycles = 0;
  double ambiguous_percent = 0;
  double contradicted_percent = 0;
  double plane_thickness_m = 0;
  double curl_violations_per_frame = 0;  ///< of methods that estimate phase jumps
};

/// All measures NaN.
Consistency unknown_consistency();

/// How many frames of a camera are enough to judge consistency: 60, or fewer of large images, which
/// are kept in memory; never fewer than 20.
int consistency_frames(const CameraModel& camera);

/// The measures of a map and of some frames that it was made of: `unwrapped` before and `filtered`
/// after filters. curl_violations_per_frame is NaN.
Consistency consistency_of(const std::vector<RangedFrame>& unwrapped,
                           const std::vector<RangedFrame>& filtered, const MapCloud& map,
                           const SensorModel& sensor);

/// Sentences about measures that exceed what right maps have. Empty if none does.
std::vector<std::string> warnings_about(const Consistency& consistency);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

#include <Eigen/Core>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/frame_errors.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

class ResidualFit;
struct ExposurePair;
struct PairGeometry;
struct SurfaceSamples;

/// B as if it had been exposed together with A, by a camera whose frequencies agree: what B
/// measured where it saw the surface that A sees in a pixel, less what FrameErrors predict of the
/// residual. Where B did not see that surface (it lies outside B's image or behind another, or its
/// amplitude is another surface's), sigma_b_cycles is `unseen_sigma_cycles`: nothing is known.
struct MatchedExposure {
  static constexpr float unseen_sigma_cycles = 1e3F;

  ImageF phase_b;
  ImageF amplitude_b;  ///< empty if the frame has no amplitudes
  ImageF sigma_b_cycles;
};

/// Estimates the systematic errors of a camera from its frames, one after the other.
///
/// Each frame is compared with itself: on bright, smooth surfaces the residual between the
/// frequencies shows how the camera moved between both exposures, and what the frequencies disagree
/// by besides (docs/unwrapping.md, equations 17 to 21). Motion belongs to one frame. Offset,
/// periodic errors and the error with amplitude belong to the camera, and become better known with
/// every frame: recursive least squares, with a memory of some fifty frames. Where the camera has
/// moved far from A's exposure to B's, the B of the frame before may be nearer, and is tried as
/// well.
///
/// Results depend on the frames so far, in their order, and on nothing else.
class ErrorTracker {
 public:
  /// A camera without size is unknown: its motion is then taken for an offset.
  ErrorTracker(const UnwrapLimits& limits, const CameraModel& camera);

  struct Tracked {
    FrameErrors errors;
    MatchedExposure b;
  };

  /// The next frame. Phases are NaN at both frequencies where either has no return; `sigma` is the
  /// noise of its phases.
  Tracked track(const DualFrequencyFrame& frame, const PhaseSigma& sigma);

  const CameraErrors& camera_errors() const { return camera_errors_; }

  /// Forgets the last frame's B, as after a gap in time; what is known of the camera stays, and how
  /// it moved may be how it will.
  void forget_last_frame() { last_ = {{}, {}, {}, last_.motion}; }

  /// All that later frames depend on, to the bit. Reading throws std::exception if it is damaged.
  void save(std::ostream& out) const;
  void load(std::istream& in);

  static constexpr int terms = CameraErrors::coefficients;
  using Terms = Eigen::Matrix<double, terms, 1>;
  using TermsMatrix = Eigen::Matrix<double, terms, terms>;

 private:
  /// B's images of the last frame, and how the camera moved to B.
  struct Exposure {
    ImageF phase;
    ImageF amplitude;
    ImageF sigma_cycles;
    ExposureMotion motion;
  };

  FrameErrors explain(const SurfaceSamples& samples, const ExposurePair& pair,
                      const PairGeometry& geometry);
  void learn(const TermsMatrix& information, const Terms& gradient, const ResidualFit& fit);
  void take_smaller_offset(const ResidualFit& fit);
  void match_moved(const SurfaceSamples& samples, const ExposurePair& pair,
                   const PairGeometry& geometry, Tracked& tracked);

  UnwrapLimits limits_;
  CameraModel camera_;
  PixelRays rays_;
  CameraErrors camera_errors_;
  TermsMatrix information_ = TermsMatrix::Zero();  ///< of the frames so far, about the coefficients
  Terms gradient_ = Terms::Zero();
  Exposure last_;
};

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/frame_errors.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

class ByteReader;
class ByteWriter;

class ResidualFit;
struct ExposurePair;
struct PairGeometry;
struct SurfaceSamples;

/// B matched to A: the images of B as if B had been exposed at the same time as A, by a camera
/// whose frequencies have no systematic difference. For each pixel of A, B is looked up where it
/// saw the same surface, and the residual that FrameErrors predict is removed from its phase. All
/// images have the size of A.
struct MatchedExposure {
  /// sigma_b_cycles of pixels whose surface B did not see: the surface is outside B's image or
  /// hidden, or B's amplitude is that of another surface. B's phase says nothing there.
  static constexpr float unseen_sigma_cycles = 1e3F;

  ImageF phase_b;         ///< cycles, 0 … 1; NaN where A has no return
  ImageF amplitude_b;     ///< empty if the frame has no amplitudes
  ImageF sigma_b_cycles;  ///< noise of phase_b
};

/// Estimates the systematic errors in which two frequencies of a camera, A and B, differ, from its
/// frames, one frame after the other
/// (docs/unwrapping.md, equations 17 to 21).
///
/// On bright, smooth surfaces the inter-frequency residual of a frame shows how the camera moved
/// between the exposures of A and B, and the systematic difference between the frequencies. The
/// motion is estimated for each frame. The offset, the periodic errors and the error with amplitude
/// are properties of the camera: recursive least squares estimates them with a memory of about
/// fifty frames. If the image moves far from A to B and B is exposed late, the B of the frame
/// before is used as well, since it may have been taken from a nearer place.
///
/// Results depend only on the frames so far and their order.
class ErrorTracker {
 public:
  /// If `camera` has no size or no focal length, motion cannot be estimated, and the offset absorbs
  /// it.
  ErrorTracker(const PairLimits& limits, const CameraModel& camera);

  /// The errors of a frame, and its B matched to A.
  struct Tracked {
    FrameErrors errors;
    MatchedExposure b;
  };

  /// The motion between A and B as another frequency tells it.
  struct Expected {
    ExposureMotion motion;
    double share = 1;      ///< time between A and B by that between A and the other frequency
    bool is_late = false;  ///< whether exposures are late, so that the B of the frame before helps
  };

  /// Estimates the errors of the next frame, matches its B to A, and learns from the frame. Phases
  /// must be NaN at both frequencies where either has no return; `sigma` is the noise of the
  /// phases. A is the first frequency of the frame, `b` is that of B. From a frame with fewer than
  /// 100 samples nothing is estimated or learned: its errors are those known of the camera. If the
  /// motion is `expected`, it is not searched for.
  Tracked track(const Frame& frame, const PhaseSigma& sigma, std::size_t b = 1,
                const std::optional<Expected>& expected = std::nullopt);

  /// Whether the exposures of the last frame that was learned from were late.
  bool is_late() const { return camera_errors_.late_frames > 0; }

  /// The camera's errors, estimated from all frames so far.
  const CameraErrors& camera_errors() const { return camera_errors_; }

  /// Forgets the B of the last frame, as after a gap in time. Keeps the errors of the camera, and
  /// its last motion, which is a starting point for the motion of the next frame.
  void forget_last_frame() { last_ = {{}, {}, {}, last_.motion}; }

  /// Writes the complete state in binary form: after load(), later frames give the same bits as
  /// without saving.
  void save(ByteWriter& out) const;

  /// Reads a state that save() wrote for the same limits and camera. Throws InputError if the
  /// bytes are damaged.
  void load(ByteReader& in);

  static constexpr int terms = CameraErrors::coefficients;
  using Terms = Eigen::Matrix<double, terms, 1>;
  using TermsMatrix = Eigen::Matrix<double, terms, terms>;

 private:
  /// B's images of the last frame, and the camera's motion from A to B.
  struct Exposure {
    ImageF phase;
    ImageF amplitude;
    ImageF sigma_cycles;
    ExposureMotion motion;
  };

  ResidualFit fit_motion(const SurfaceSamples& samples, const ExposurePair& pair,
                         const PairGeometry& geometry, const std::optional<Expected>& expected,
                         bool& is_late) const;
  FrameErrors explain(const SurfaceSamples& samples, const ExposurePair& pair,
                      const PairGeometry& geometry, const std::optional<Expected>& expected);
  void learn(const TermsMatrix& information, const Terms& gradient, const ResidualFit& fit);
  void take_smaller_offset(const ResidualFit& fit);
  void match_moved(const SurfaceSamples& samples, const ExposurePair& pair,
                   const PairGeometry& geometry, Tracked& tracked);

  PairLimits limits_;
  CameraModel camera_;
  PixelRays rays_;
  CameraErrors camera_errors_;
  TermsMatrix information_ = TermsMatrix::Zero();  ///< I of equation 21
  Terms gradient_ = Terms::Zero();                 ///< h of equation 21
  Exposure last_;
};

}  // namespace tofmap

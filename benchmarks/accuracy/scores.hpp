// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap::accuracy {

/// Compares confidences with the share of right wraps, in 20 bins of confidence.
class Calibration {
 public:
  void add(float confidence, bool is_right);
  void add(const Calibration& other);

  /// The expected calibration error: the mean absolute difference between the mean confidence and
  /// the share of right wraps in a bin, weighted by pixels.
  double error_percent() const;

  /// The contribution of some of these pixels, such as those of one frame, to error_percent(). The
  /// contributions of all frames add up to it.
  double error_percent_of(const Calibration& some) const;

  /// The pixels with a confidence from least_confidence up to that of the next bin. The last bin
  /// has no upper limit.
  struct Bin {
    double least_confidence = 0;
    double mean_confidence = 0;
    double right_share = 0;
    double pixel_share = 0;  ///< of all pixels
  };

  /// Bins that are finer at high confidences than those of error_percent(). Empty bins are left
  /// out.
  std::vector<Bin> reliability() const;

 private:
  static constexpr std::size_t bins = 20;
  static constexpr std::array<double, 12> limits{0,    0.3,  0.5,  0.7,   0.8,   0.9,
                                                 0.95, 0.98, 0.99, 0.995, 0.999, 0.9999};

  struct Tally {
    double pixels = 0;
    double confidence = 0;
    double right = 0;
  };

  std::array<Tally, limits.size()> tallies_{};
  std::array<double, bins> confidence_{};
  std::array<double, bins> right_{};
  double all_ = 0;
};

/// Numbers of pixels of one frame. A wrap is wrong if the range is off by more than half a
/// wavelength of A.
struct FrameScore {
  double returns = 0;          ///< pixels with a phase at both frequencies and a true range
  double pixels = 0;           ///< pixels of `returns` that have a range
  double wrong = 0;            ///< pixels of `pixels` with a wrong wrap
  double sure = 0;             ///< the most confident of `pixels`, up to 90 % of `returns`
  double sure_wrong = 0;       ///< pixels of `sure` with a wrong wrap
  double square_error_m2 = 0;  ///< sum of squared errors over the pixels with a right wrap
  bool is_converged = false;   ///< UnwrapResult::converged; false if the method has none
  double milliseconds = 0;
  Calibration calibration;

  double wrong_percent() const { return pixels > 0 ? 100 * wrong / pixels : 0; }
  double sure_wrong_percent() const { return sure > 0 ? 100 * sure_wrong / sure : 0; }
};

/// The scores of all frames of a case.
struct Score {
  std::vector<FrameScore> frames;
  Calibration calibration;

  double wrong_percent() const;  ///< mean over frames
  double worst_percent() const;  ///< the frame with the largest share of wrong wraps
  double sure_wrong_percent() const;
  double coverage_percent() const;
  double range_rmse_m() const;       ///< of pixels with a right wrap, mean over frames
  double converged_percent() const;  ///< of the frames
  double milliseconds() const;       ///< mean over frames
};

/// Adds one frame to `score`. Pixels without a true range do not count. The caller sets time and
/// convergence.
void add_frame(const Frame& frame, const RangeImage& image, const ImageF& truth_m,
               double wavelength_a_m, Score& score);

/// Adds the frames of `other`.
void add_score(const Score& other, Score& score);

}  // namespace tofmap::accuracy

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap::accuracy {

/// Shares of right wraps against confidences, in 20 bins.
class Calibration {
 public:
  void add(float confidence, bool is_right);
  void add(const Calibration& other);

  /// Mean difference between confidence and share of right wraps, weighted by pixels.
  double error_percent() const;

  /// What some of these pixels, those of one frame, add to error_percent(): its sum over all
  /// frames.
  double error_percent_of(const Calibration& some) const;

  /// The pixels whose confidence is at least c_k and less than c_(k+1); the last bin has no end.
  struct Bin {
    double least_confidence = 0;
    double mean_confidence = 0;
    double right_share = 0;
    double pixel_share = 0;  ///< of all pixels
  };

  /// Finer than those of error_percent where confidences are high; without bins that are empty.
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

/// Pixels of one frame. A wrap is wrong if the range is off by more than half a wavelength of A.
struct FrameScore {
  double returns = 0;          ///< with a phase at both frequencies, and a truth
  double pixels = 0;           ///< of these, with a range
  double wrong = 0;            ///< of these, with a wrong wrap
  double sure = 0;             ///< the most confident ones, 90 % of the returns
  double sure_wrong = 0;       ///< of these, with a wrong wrap
  double square_error_m2 = 0;  ///< sum over the pixels with a right wrap
  bool is_converged = false;   ///< no curl is left; of methods of phase jumps
  double milliseconds = 0;
  Calibration calibration;

  double wrong_percent() const { return pixels > 0 ? 100 * wrong / pixels : 0; }
  double sure_wrong_percent() const { return sure > 0 ? 100 * sure_wrong / sure : 0; }
};

/// All frames of a case.
struct Score {
  std::vector<FrameScore> frames;
  Calibration calibration;

  double wrong_percent() const;  ///< mean over frames
  double worst_percent() const;  ///< the frame with the largest share of wrong wraps
  double sure_wrong_percent() const;
  double coverage_percent() const;
  double range_rmse_m() const;       ///< of right wraps, mean over frames
  double converged_percent() const;  ///< of the frames
  double milliseconds() const;       ///< mean over frames
};

/// Adds one frame to `score`. Pixels without a truth do not count. Time and
/// convergence are left to the caller.
void add_frame(const DualFrequencyFrame& frame, const RangeImage& image, const ImageF& truth_m,
               double wavelength_a_m, Score& score);

/// Adds the frames of `other`.
void add_score(const Score& other, Score& score);

}  // namespace tofmap::accuracy

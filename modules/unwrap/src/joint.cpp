// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "joint.hpp"

#include "counted_ranges.hpp"
#include "tofmap/unwrap/exposure_motion.hpp"
#include "tofmap/unwrap/range_fusion.hpp"

namespace tofmap {
namespace {

/// The options of `joint` as its stages know them.
CountEstimation count_estimation(const UnwrapOptions& options) {
  return {.prior = {.outlier_share = options.outlier_share,
                    .slope_m = options.slope_m,
                    .amplitude_edges = options.amplitude_edges,
                    .mixed_pixels = options.mixed_pixels},
          .iterations = options.count_iterations,
          .scales = options.scales};
}

/// Makes pixels invalid that have a rival count which the pair of frequencies cannot tell from
/// the chosen one, and which is nearly as likely.
void drop_ambiguous(const CountBeliefs& beliefs, const BeatLimits& limits, RangeImage& image) {
  constexpr float nearly = 0.1F;
  for (Eigen::Index v = 0; v < image.rows(); ++v) {
    for (Eigen::Index u = 0; u < image.cols(); ++u) {
      if (!image.valid(v, u)) continue;
      if (beliefs.rival_probability(v, u) < nearly * beliefs.probability(v, u)) continue;
      if (can_tell_apart(limits, beliefs.count(v, u), beliefs.rival(v, u))) continue;
      image.invalidate(v, u, InvalidReason::ambiguous);
    }
  }
}

/// Ranges from both frequencies; B's are brought back to the instant of A if the camera's rays are
/// known.
FusedRanges ranges_of_both(const MeasuredFrame& frame, const ImageU8& counts,
                           const BeatLimits& limits, const PixelRays& rays) {
  const RangePair pair = pair_ranges(frame.returns, counts, limits, frame.sigma);
  if (!same_size(rays.x, counts)) return fuse_ranges(pair, {});
  const ImageF sigma_m = (pair.variance_a_m2 + pair.variance_b_m2).sqrt();
  const ExposureMotion motion =
      estimate_exposure_motion(pair.range_a_m, pair.residual_m, sigma_m, rays);
  return fuse_ranges(
      pair, motion.pixels > 0 ? range_shrinkage_m(motion, pair.range_a_m, rays) : ImageF());
}

}  // namespace

UnwrapResult unwrap_jointly(CountEstimator& estimator, const MeasuredFrame& frame,
                            const BeatLimits& limits, const PixelRays& rays,
                            const UnwrapOptions& options) {
  const CountBeliefs beliefs =
      estimator.estimate(frame.returns, limits, frame.noise, count_estimation(options));
  UnwrapResult result;
  if (options.fuse_frequencies) {
    const FusedRanges fused = ranges_of_both(frame, beliefs.count, limits, rays);
    result.image =
        make_range_image(fused.range_m, fused.sigma_m, beliefs.count, beliefs.probability);
  } else {
    result.image = make_range_image(frame.returns.phase_a, frame.sigma.a_cycles, beliefs.count,
                                    beliefs.probability, limits);
  }
  drop_ambiguous(beliefs, limits, result.image);
  result.iterations = beliefs.iterations;
  result.largest_message_change = beliefs.largest_message_change;
  return result;
}

}  // namespace tofmap

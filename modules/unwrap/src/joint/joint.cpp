// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "joint/joint.hpp"

#include "common/counted_ranges.hpp"
#include "joint/wrap_count_confidence.hpp"
#include "tofmap/unwrap/common/range_fusion.hpp"

namespace tofmap {
namespace {

/// The options of WrapCountEstimator.
WrapCountOptions count_estimation(const UnwrapOptions& options) {
  return {.prior = {.outlier_share = options.outlier_share,
                    .slope_m = options.slope_m,
                    .amplitude_edges = options.amplitude_edges,
                    .mixed_pixels = options.mixed_pixels},
          .iterations = options.count_iterations,
          .scales = options.scales};
}

/// Invalidates pixels whose runner-up is nearly as probable as the chosen wrap count, if the
/// frequencies cannot tell the two apart.
void drop_ambiguous(const WrapCountBeliefs& beliefs, const UnwrapLimits& limits,
                    RangeImage& image) {
  constexpr float nearly = 0.1F;
  for (Eigen::Index v = 0; v < image.rows(); ++v) {
    for (Eigen::Index u = 0; u < image.cols(); ++u) {
      if (!image.valid(v, u)) continue;
      if (beliefs.runner_up_probability(v, u) < nearly * beliefs.probability(v, u)) continue;
      if (can_tell_apart(limits, beliefs.count(v, u), beliefs.runner_up(v, u))) continue;
      image.invalidate(v, u, InvalidReason::ambiguous);
    }
  }
}

}  // namespace

UnwrapResult unwrap_jointly(WrapCountEstimator& estimator, const MeasuredFrame& frame,
                            const UnwrapLimits& limits, const UnwrapOptions& options) {
  const WrapCountBeliefs beliefs = estimator.estimate(
      frame.returns, limits, frame.sigma, frame.residual_sigma_m, count_estimation(options));
  const ImageF& sigma_cycles = frame.sigma.cycles[0];
  const ImageF unknown = ImageF::Zero(beliefs.count.rows(), beliefs.count.cols());
  UnwrapResult result;
  if (options.fuse_frequencies) {
    const FusedRanges fused =
        fuse_ranges(frame.returns, beliefs.count, limits, frame.sigma, frame.residual_sigma_m);
    result.image = make_range_image(fused.range_m, fused.sigma_m, beliefs.count, unknown);
  } else {
    result.image = make_range_image(frame.returns.phases[0], sigma_cycles, beliefs.count, unknown,
                                    limits.wavelength_m());
  }
  result.image.confidence =
      wrap_count_confidence(beliefs, result.image.range_m, sigma_cycles, limits);
  drop_ambiguous(beliefs, limits, result.image);
  result.iterations = beliefs.iterations;
  return result;
}

}  // namespace tofmap

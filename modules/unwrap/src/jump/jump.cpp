// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "jump/jump.hpp"

#include "common/counted_ranges.hpp"
#include "jump/confidence.hpp"
#include "tofmap/unwrap/jump/jump_integration.hpp"

#include <algorithm>

namespace tofmap {
namespace {

/// The anchored wrap counts, clamped to 0 … count_a − 1; invalid in pixels without a region.
ImageU8 absolute_counts(const RelativeCounts& relative, int count_a) {
  ImageU8 counts =
      ImageU8::Constant(relative.count.rows(), relative.count.cols(), invalid_wrap_count);
  for (Eigen::Index i = 0; i < counts.size(); ++i) {
    const int region = relative.region.data()[i];
    if (region == RelativeCounts::no_region) continue;
    const int n = relative.count.data()[i] + relative.anchor[static_cast<std::size_t>(region)];
    counts.data()[i] = static_cast<std::uint8_t>(std::clamp(n, 0, count_a - 1));
  }
  return counts;
}

/// The result of integration.
struct Integrated {
  ImageU8 counts;
  ImageF confidence;
  int regions = 0;
};

Integrated integrated(const JumpEstimate& jumps, const MeasuredFrame& frame,
                      const PairLimits& limits, const JumpMethod& method) {
  const RelativeCounts relative =
      integrate_jumps(jumps.beliefs.marginals, jumps.evidence, frame.valid);
  // The paper corrects a wrapped range by adding λ_A once (section II.C), so it has two wrap
  // counts.
  ImageU8 counts = absolute_counts(relative, method.has_all_counts ? limits.count_a : 2);
  ImageF confidence = jump_confidence(counts, jumps.beliefs.marginals);
  return {std::move(counts), std::move(confidence), relative.region_count};
}

Integrated integrated_with_residual(const JumpEstimate& jumps, const MeasuredFrame& frame,
                                    const PairLimits& limits, const UnwrapOptions& options) {
  const ResidualCost residual(frame.returns, limits, frame.sigma, frame.residual_sigma_m[1]);
  const RelativeCounts relative =
      integrate_jumps_with_residual(jumps.beliefs.marginals, jumps.evidence, frame.valid, residual,
                                    jumps.inputs.pixel_counts, options.objection_share);
  ImageU8 counts = absolute_counts(relative, limits.count_a);
  ImageF confidence = jump_and_residual_confidence(counts, jumps.beliefs.marginals, residual);
  return {std::move(counts), std::move(confidence), relative.region_count};
}

}  // namespace

UnwrapResult unwrap_by_jumps(JumpEstimator& estimator, const MeasuredFrame& frame,
                             const PairLimits& limits, const JumpMethod& method,
                             const UnwrapOptions& options) {
  const JumpEstimate& jumps =
      estimator.estimate(frame.returns, frame.sigma, limits, method, options);
  const Integrated found = method.regards_residual
                               ? integrated_with_residual(jumps, frame, limits, options)
                               : integrated(jumps, frame, limits, method);
  UnwrapResult result;
  result.image = make_range_image(frame.returns.phases[0], frame.sigma.cycles[0], found.counts,
                                  found.confidence, limits.wavelength_a_m);
  result.iterations = jumps.beliefs.iterations;
  result.curl_violations = jumps.beliefs.curl_violations;
  result.converged = jumps.beliefs.converged;
  result.regions = found.regions;
  return result;
}

}  // namespace tofmap

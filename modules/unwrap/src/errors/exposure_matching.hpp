// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "errors/exposure_pair.hpp"

#include <tofmap/unwrap/errors/error_tracker.hpp>

namespace tofmap {

/// A MatchedExposure of A's size to start from: all pixels are unseen, B's phases are those of the
/// same pixels, and amplitudes, if the pair has any, are next to nothing.
MatchedExposure unmatched(const ExposurePair& pair);

/// The step from the exposure of A to that of B.
struct ExposureStep {
  ExposureMotion motion;
  double flow_px = 0;  ///< the motion shifts nine tenths of the image by less than this

  /// Standard deviation, in pixels, of the position in B at which a pixel of A is looked up, on
  /// surfaces whose slope is known, so that the fraction of a pixel is corrected for.
  double place_sigma_px() const;

  /// The same standard deviation where the surface bends or ends, so that the slope is unknown.
  double rough_sigma_px() const;
};

/// Fills in those pixels of `out` that are still unseen, from the exposure of B after `step`. Each
/// wrap count puts the surface at another range, and thus perhaps into another pixel of B. Among
/// the wrap counts whose surface B did see, the one whose residual is nearest to the prediction
/// decides.
void match_exposure(const ExposurePair& pair, const PairGeometry& geometry,
                    const CameraErrors& camera, const ExposureStep& step, MatchedExposure& out);

/// Fills in `out` as match_exposure() does, but for motions that shift the image by less than about
/// a pixel: then B sees every surface in the same pixel as A, and the slope of the surface corrects
/// for the fraction of a pixel.
void match_still_exposure(const ExposurePair& pair, const PairGeometry& geometry,
                          const CameraErrors& camera, const ExposureStep& step,
                          MatchedExposure& out);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "errors/exposure_pair.hpp"

#include <tofmap/unwrap/errors/error_tracker.hpp>

namespace tofmap {

/// Nothing seen yet: every pixel of A's size unseen, B's phase that of the same pixel.
MatchedExposure unmatched(const ExposurePair& pair);

/// How B was exposed after A.
struct ExposureStep {
  ExposureMotion motion;
  double flow_px = 0;  ///< by how far it shifts the image: most of it by less

  /// Standard deviations of the place in B that a pixel of A is looked up in, pixels: where slopes
  /// make up for a part of a pixel, and where there is no slope to do so.
  double place_sigma_px() const;
  double rough_sigma_px() const;
};

/// Fills in the pixels that `out` has not seen, from B's exposure after `step`. For every count
/// the surface lies elsewhere, and B may see it in another pixel; of those that B did see, the
/// count whose residual fits what is predicted of it best decides.
void match_exposure(const ExposurePair& pair, const PairGeometry& geometry,
                    const CameraErrors& camera, const ExposureStep& step, MatchedExposure& out);

/// The same for a motion of about a pixel or less, after which B sees every surface in the pixel of
/// A: slopes make up for the rest.
void match_still_exposure(const ExposurePair& pair, const PairGeometry& geometry,
                          const CameraErrors& camera, const ExposureStep& step,
                          MatchedExposure& out);

}  // namespace tofmap

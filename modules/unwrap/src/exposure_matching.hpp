// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exposure_pair.hpp"

#include <tofmap/unwrap/error_tracker.hpp>

namespace tofmap {

/// Nothing seen yet: every pixel of A's size unseen, B's phase that of the same pixel.
MatchedExposure unmatched(const ExposurePair& pair);

/// Fills in the pixels that `out` has not seen, from B's exposure after `motion`. For every count
/// the surface lies elsewhere, and B may see it in another pixel; of those that B did see, the
/// count whose residual fits what is predicted of it best decides.
void match_exposure(const ExposurePair& pair, const PairGeometry& geometry,
                    const CameraErrors& camera, const ExposureMotion& motion, MatchedExposure& out);

/// The same for a motion of about a pixel or less, after which B sees every surface in the pixel of
/// A: slopes make up for the rest.
void match_still_exposure(const ExposurePair& pair, const PairGeometry& geometry,
                          const CameraErrors& camera, const ExposureMotion& motion,
                          MatchedExposure& out);

}  // namespace tofmap

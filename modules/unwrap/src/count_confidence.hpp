// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/count_propagation.hpp>

namespace tofmap {

/// How often counts that are believed in so much are right, 0 … 1: the confidence of `joint`
/// (docs/unwrapping.md, equation 22). At the same noise it is the larger, the larger the odds are.
/// `noise_share` is the noise of the residual over the residual step; any number where there is no
/// count, and the confidence is 0.
ImageF count_confidence(const CountBeliefs& beliefs, const ImageF& noise_share);

}  // namespace tofmap

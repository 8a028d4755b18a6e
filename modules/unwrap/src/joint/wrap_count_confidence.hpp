// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>
#include <tofmap/unwrap/joint/wrap_count_propagation.hpp>

namespace tofmap {

/// How often counts that are believed in so much are right, 0 … 1: the confidence of `joint`
/// (docs/unwrapping.md, equation 22). At the same noise it is the larger, the larger the odds are.
/// The noise is that of the residual over the residual step, as if both frequencies had A's: B may
/// be of another exposure. Where there is no count `sigma_a_cycles` is any number, and the
/// confidence 0.
ImageF wrap_count_confidence(const WrapCountBeliefs& beliefs, const ImageF& sigma_a_cycles,
                             const UnwrapLimits& limits);

}  // namespace tofmap

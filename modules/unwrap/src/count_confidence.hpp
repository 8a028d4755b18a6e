// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/count_propagation.hpp>

namespace tofmap {

/// How often counts that are believed in so much are right, 0 … 1: the confidence of `joint`
/// (docs/unwrapping.md, equation 22). The larger the odds, the larger it is. 0 where there is no
/// count.
ImageF count_confidence(const CountBeliefs& beliefs);

}  // namespace tofmap

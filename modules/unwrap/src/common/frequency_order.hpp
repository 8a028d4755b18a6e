// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <tofmap/core/range_image.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>

namespace tofmap {

/// All frequencies, counted from 0, with the one first whose wrap counts `joint` estimates; the
/// others stay in their order. It is counted_frequency(), or the first one if that would need more
/// than 255 wrap counts.
std::vector<std::size_t> counting_order(const UnwrapLimits& limits);

/// The limits of the frequencies `order`, with the wrap counts of its first one.
UnwrapLimits in_order(const UnwrapLimits& limits, const std::vector<std::size_t>& order);

/// Sets the wrap counts of a frequency with these phases to those at the ranges of the image, which
/// another frequency has found.
void count_at_ranges(const ImageF& phase, double wavelength_m, RangeImage& image);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/calibration/fixed_pattern_fit.hpp>

namespace tofmap::app {

/// Whether the ranges of pixels hardly changed, so that a pattern contains errors that are not of
/// the pixels: more than nine tenths of one with four periods per wavelength are left in it.
bool shows_one_range(const PatternEstimate& estimate);

/// The pattern to store: significant estimates, and 0 for the other frequencies. Estimates that
/// shows_one_range() are stored only if `with_one_range`. Empty if nothing but zeros is left.
FixedPattern stored_pattern(const std::vector<PatternEstimate>& estimates, bool with_one_range);

/// A line on the pattern of each frequency: its standard deviation, the error that is left, or why
/// it is not stored. `with_one_range` is that of stored_pattern().
std::vector<std::string> pattern_lines(const std::vector<PatternEstimate>& estimates,
                                       bool with_one_range);

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <tofmap/core/frame.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>

namespace tofmap {

/// The two frequencies, A and B, that `jump` and `paper` compare, counted from 0. `single` uses A
/// alone and has no B.
struct ComparedPair {
  std::size_t a = 0;
  std::optional<std::size_t> b = 1;
};

/// The pair that the options name. What they leave open is chosen so that the two frequencies are
/// unambiguous up to the longest range; A is then the one with the shorter wavelength, but of two
/// frequencies the first one. Throws UsageError if the method needs frequencies that the recording
/// does not have, or if both are the same.
ComparedPair compared_pair(const UnwrapOptions& options, const Modulation& modulation);

/// The wrap counts that a pair can have: those of `limits`, which are those of all frequencies, but
/// of more than two frequencies not beyond the range up to which the pair is unambiguous.
PairLimits pair_limits(const ComparedPair& pair, const Modulation& modulation,
                       const UnwrapLimits& limits);

/// A warning if the method compares two of more frequencies that are not unambiguous up to the
/// longest range of all. Throws as compared_pair() and unwrap_limits() do.
std::optional<std::string> pair_warning(const UnwrapOptions& options, const SensorModel& sensor);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/unwrap/common/frame_errors.hpp>

namespace tofmap {

/// How both frequencies of a recording agree, each pixel by itself with the wraps that make them
/// agree best.
struct ResidualSurvey {
  /// What A measures more than B; median. Of several that fit as well, the one nearest to zero.
  double offset_m = 0;
  /// Other offsets that fit as well, nearest to zero first: another wrap of both makes up for the
  /// difference.
  std::vector<double> other_offsets_m;
  double spread_m = 0;          ///< of single pixels around it; robust standard deviation
  double swapped_spread_m = 0;  ///< as if A had been taken at B's frequency, and B at A's
  /// By how much the difference between A and B changes with one more wrap of both.
  double ambiguity_m = 0;
};

/// Nothing if too few pixels have returns at both frequencies.
std::optional<ResidualSurvey> survey_residual(const std::vector<DualFrequencyFrame>& frames,
                                              const SensorModel& sensor);

/// If A and B do not belong together, a sentence that says so, with the remedy.
std::optional<std::string> pairing_warning(const ResidualSurvey& residual);

/// A sentence with the remedy if the offset between the frequencies is not sure: unwrapping
/// estimated another over the frames (`camera`, null if nothing is known), or it is so large that
/// other offsets that fit the phases are nearly as likely. Empty if there is no offset worth
/// telling, or if both agree on a small one, which unwrapping allows for.
std::optional<std::string> offset_warning(const ResidualSurvey& residual,
                                          const CameraErrors* camera);

/// A sentence if the pair of frequencies tells no wrap counts apart.
std::optional<std::string> frequency_pair_warning(const Modulation& modulation);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/common/compared_pair.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <vector>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

/// The range up to which two frequencies are unambiguous.
double combined_range_m(const ComparedPair& pair, const Modulation& modulation) {
  Modulation both;
  both.frequencies_hz = {modulation.frequencies_hz[pair.a], modulation.frequencies_hz[*pair.b]};
  return combined_range_m(both, noise_tolerance_cycles);
}

/// Throws UsageError unless an option that names a frequency, counted from 1, names one of these.
void check(int named, const char* option, const Modulation& modulation) {
  if (named <= static_cast<int>(modulation.count())) return;
  throw UsageError(std::string("unwrap.") + option + " is " + std::to_string(named) +
                   ", but the recording has " +
                   counted(modulation.count(), "frequency", "frequencies"));
}

}  // namespace

ComparedPair compared_pair(const UnwrapOptions& options, const Modulation& modulation) {
  const int first = options.pair_first;
  const int second = options.pair_second;
  check(first, "pair_first", modulation);
  if (options.method == UnwrapMethod::single) {
    const std::size_t a = first > 0 ? static_cast<std::size_t>(first) - 1 : 0;
    return {a, {}};
  }
  if (modulation.count() == 1) {
    throw UsageError("unwrap.method: " + std::string(name_of(options.method)) +
                     " compares two frequencies, but the recording has one; use joint or single");
  }
  check(second, "pair_second", modulation);
  if (first > 0 && first == second) {
    throw UsageError("unwrap.pair_first and unwrap.pair_second must differ");
  }
  std::optional<ComparedPair> best;
  double best_m = 0;
  for (std::size_t a = 0; a < modulation.count(); ++a) {
    if (first > 0 && a != static_cast<std::size_t>(first) - 1) continue;
    for (std::size_t b = 0; b < modulation.count(); ++b) {
      if (b == a || (second > 0 && b != static_cast<std::size_t>(second) - 1)) continue;
      const bool is_in_order =
          modulation.count() == 2 ? a < b : modulation.wavelength_m(a) < modulation.wavelength_m(b);
      if (first == 0 && second == 0 && !is_in_order) continue;
      const double range_m = combined_range_m({a, b}, modulation);
      if (best && range_m <= best_m) continue;
      best = ComparedPair{a, b};
      best_m = range_m;
    }
  }
  return *best;
}

PairLimits pair_limits(const ComparedPair& pair, const Modulation& modulation,
                       const UnwrapLimits& limits) {
  PairLimits out = limits.pair(pair.a, pair.b.value_or(limits.frequencies()));
  if (limits.frequencies() <= 2 || !pair.b) return out;
  out.max_range_m = std::min(out.max_range_m, combined_range_m(pair, modulation));
  out.count_a = wrap_limit(out.wavelength_a_m, out.max_range_m);
  return out;
}

std::optional<std::string> pair_warning(const UnwrapOptions& options, const SensorModel& sensor) {
  const bool compares_two =
      options.method == UnwrapMethod::jump || options.method == UnwrapMethod::paper;
  const Modulation& modulation = sensor.modulation;
  if (!compares_two || modulation.count() <= 2) return std::nullopt;
  const UnwrapLimits limits = unwrap_limits(sensor, options.max_range_m);
  const ComparedPair pair = compared_pair(options, modulation);
  const double pair_m = pair_limits(pair, modulation, limits).max_range_m;
  if (pair_m >= limits.max_range_m) return std::nullopt;
  std::ostringstream text;
  text << name_of(options.method) << " compares " << 1e-6 * modulation.frequencies_hz[pair.a]
       << " and " << 1e-6 * modulation.frequencies_hz[*pair.b]
       << " MHz, which are unambiguous up to " << std::fixed << std::setprecision(2) << pair_m
       << " m only; surfaces beyond appear nearer by that much; joint uses all frequencies, up to "
       << limits.max_range_m << " m";
  return text.str();
}

}  // namespace tofmap

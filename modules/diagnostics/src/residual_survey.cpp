// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/residual_survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>

namespace tofmap {
namespace {

/// Every third pixel is compared.
constexpr int pixel_stride = 3;

/// At least this many of the compared pixels must have returns at both frequencies.
constexpr std::size_t least_pixels = 300;

/// The phases of a pixel with returns at both frequencies.
struct PhasePair {
  double a_cycles;
  double b_cycles;
};

std::vector<PhasePair> phase_pairs(const std::vector<Frame>& frames, std::size_t b) {
  std::vector<PhasePair> pairs;
  for (const Frame& frame : frames) {
    for (Eigen::Index i = 0; i < frame.phases[0].size(); i += pixel_stride) {
      const PhasePair pair{frame.phases[0].data()[i], frame.phases[b].data()[i]};
      if (!std::isnan(pair.a_cycles) && !std::isnan(pair.b_cycles)) pairs.push_back(pair);
    }
  }
  return pairs;
}

/// The possible differences of A's range minus B's range, given the phases of a pixel and the wrap
/// counts that both frequencies may have.
class Differences {
 public:
  explicit Differences(const SensorModel& sensor)
      : a_m_(sensor.modulation.wavelength_m(0)), b_m_(sensor.modulation.wavelength_m(1)) {
    constexpr double tolerance_cycles = 0.05;  // more noise hides which wrap counts are right
    const double combined_m = combined_range_m(sensor.modulation, tolerance_cycles);
    const double farthest_m =
        sensor.max_range_m > 0 ? std::min(sensor.max_range_m, combined_m) : combined_m;
    count_a_ = wrap_limit(a_m_, farthest_m);
    farthest_m_ = farthest_m + tolerance_cycles * a_m_;
  }

  double most_m() const { return std::min(a_m_, b_m_) / 2; }
  double ambiguity_m() const { return std::abs(a_m_ - b_m_); }

  /// Calls `use` once per wrap count of A, with the difference nearest to `about_m` that it allows.
  template <class Use>
  void of(const PhasePair& phases, double about_m, Use use) const {
    for (int n = 0; n < count_a_; ++n) {
      const double range_a_m = a_m_ * (phases.a_cycles + n);
      if (n > 0 && range_a_m > farthest_m_) return;
      const double difference_m =
          about_m +
          frequency_residual_m(a_m_, b_m_, phases.a_cycles + n - about_m / a_m_, phases.b_cycles);
      const double wraps_b = (range_a_m - difference_m) / b_m_ - phases.b_cycles;
      if (wraps_b > -0.5) use(difference_m);
    }
  }

  /// The difference that is nearest to `about_m`. Empty if no pair of wrap counts is possible.
  std::optional<double> nearest_m(const PhasePair& phases, double about_m) const {
    std::optional<double> nearest;
    of(phases, about_m, [&](double difference_m) {
      if (!nearest || std::abs(difference_m - about_m) < std::abs(*nearest - about_m)) {
        nearest = difference_m;
      }
    });
    return nearest;
  }

 private:
  double a_m_;
  double b_m_;
  double farthest_m_;
  int count_a_;
};

/// A histogram over the differences of A's range minus B's range: counts the pixels in which each
/// difference is possible.
class Support {
 public:
  explicit Support(double most_m)
      : half_(static_cast<int>(std::ceil(most_m / step_m))),
        counts_(static_cast<std::size_t>(2 * half_ + 1), 0.0) {}

  void add(double difference_m) {
    const auto bin = static_cast<int>(std::lround(difference_m / step_m));
    if (std::abs(bin) <= half_) ++counts_[static_cast<std::size_t>(bin + half_)];
  }

  /// The local maxima that are at least 95 % as high as the highest, nearest to zero first.
  std::vector<double> peaks_m() const {
    const std::vector<double> smooth = smoothed();
    constexpr double nearly_all = 0.95;
    const double least = nearly_all * *std::ranges::max_element(smooth);
    std::vector<double> peaks;
    if (least <= 0) return peaks;
    for (int bin = -half_; bin <= half_; ++bin) {
      const double value = smooth[static_cast<std::size_t>(bin + half_)];
      if (value >= least && is_highest_nearby(smooth, bin)) peaks.push_back(bin * step_m);
    }
    std::ranges::sort(peaks, {}, [](double peak_m) { return std::abs(peak_m); });
    return peaks;
  }

 private:
  static constexpr double step_m = 0.002;
  static constexpr int reach = 30;  ///< half width of the smoothing kernel, steps

  /// The histogram smoothed with a Gaussian whose standard deviation is a third of `reach`: 2 cm.
  std::vector<double> smoothed() const {
    std::vector<double> smooth(counts_.size(), 0.0);
    for (int shift = -reach; shift <= reach; ++shift) {
      const double weight = std::exp(-4.5 * shift * shift / (reach * reach));
      for (int i = std::max(0, -shift); i < std::min(size(), size() - shift); ++i) {
        smooth[static_cast<std::size_t>(i)] +=
            weight * counts_[static_cast<std::size_t>(i + shift)];
      }
    }
    return smooth;
  }

  bool is_highest_nearby(const std::vector<double>& smooth, int bin) const {
    const int place = bin + half_;
    const auto begin = smooth.begin() + std::max(0, place - reach);
    const auto end = smooth.begin() + std::min(size(), place + reach + 1);
    return std::max_element(begin, end) - smooth.begin() == place;
  }

  int size() const { return static_cast<int>(counts_.size()); }

  int half_;
  std::vector<double> counts_;
};

/// Robust standard deviation about the median.
double spread_of(std::vector<float> values) {
  const float middle = median(values);
  for (float& value : values) value = std::abs(value - middle);
  return sigma_of_median_deviation * double{median(values)};
}

/// See ResidualSurvey for the meaning of offsets and spread.
struct Agreement {
  std::vector<double> offsets_m;  ///< all that fit equally well, nearest to zero first
  double spread_m = 0;            ///< about the first of the offsets
};

/// Finds the offsets that fit the phases best. No offsets are found if no wrap counts are possible.
Agreement agreement(const std::vector<PhasePair>& pairs, const SensorModel& sensor) {
  const Differences differences(sensor);
  Support support(differences.most_m());
  for (const PhasePair& pair : pairs) {
    differences.of(pair, 0, [&](double difference_m) { support.add(difference_m); });
  }
  Agreement found;
  found.offsets_m = support.peaks_m();
  if (found.offsets_m.empty()) return found;
  std::vector<float> nearest_m;
  for (const PhasePair& pair : pairs) {
    const auto nearest = differences.nearest_m(pair, found.offsets_m.front());
    if (nearest) nearest_m.push_back(static_cast<float>(*nearest));
  }
  if (nearest_m.empty()) return {};
  const double refined_m = double{median(nearest_m)} - found.offsets_m.front();
  for (double& offset_m : found.offsets_m) offset_m += refined_m;
  found.spread_m = spread_of(std::move(nearest_m));
  return found;
}

/// "133 mm more".
std::string more_or_less(double offset_m) {
  return fmt::format("{:.0f} mm {}", 1000 * std::abs(offset_m), offset_m < 0 ? "less" : "more");
}

/// "133 mm more than B, or 200 mm less".
std::string offset_text(const ResidualSurvey& residual) {
  std::string text =
      more_or_less(residual.offset_m) + " than " + frequency_name(residual.frequency);
  constexpr std::size_t some = 2;
  for (std::size_t i = 0; i < std::min(some, residual.other_offsets_m.size()); ++i) {
    text += ", or " + more_or_less(residual.other_offsets_m[i]);
  }
  return text;
}

/// Compares the first frequency with `b`. Empty if too few pixels have returns at both.
std::optional<ResidualSurvey> survey_pair(const std::vector<Frame>& frames,
                                          const SensorModel& sensor, std::size_t b) {
  const std::vector<PhasePair> pairs = phase_pairs(frames, b);
  if (pairs.size() < least_pixels) return std::nullopt;
  const SensorModel of_pair = with_frequencies(sensor, {0, b});
  const Agreement as_is = agreement(pairs, of_pair);
  if (as_is.offsets_m.empty()) return std::nullopt;
  ResidualSurvey survey;
  survey.frequency = b;
  survey.offset_m = as_is.offsets_m.front();
  survey.other_offsets_m.assign(as_is.offsets_m.begin() + 1, as_is.offsets_m.end());
  survey.spread_m = as_is.spread_m;
  survey.swapped_spread_m = agreement(pairs, with_frequencies(sensor, {b, 0})).spread_m;
  survey.ambiguity_m = Differences(of_pair).ambiguity_m();
  return survey;
}

constexpr double telling_ratio = 0.5;

/// The spread of the differences between A and the images of `b` if these have the wavelength of
/// `c`, relative to that of unrelated phases (pairing_warning()). Infinite if too few pixels have
/// returns.
double relative_spread(const std::vector<Frame>& frames, const SensorModel& sensor, std::size_t b,
                       std::size_t c) {
  const std::vector<PhasePair> pairs = phase_pairs(frames, b);
  if (pairs.size() < least_pixels) return std::numeric_limits<double>::infinity();
  const SensorModel of_pair = with_frequencies(sensor, {0, c});
  const Agreement found = agreement(pairs, of_pair);
  if (found.offsets_m.empty()) return std::numeric_limits<double>::infinity();
  return found.spread_m / Differences(of_pair).ambiguity_m();
}

/// Finds frequencies other than A that seem to be exchanged.
void find_exchanged(const std::vector<Frame>& frames, const SensorModel& sensor,
                    std::vector<ResidualSurvey>& surveys) {
  for (ResidualSurvey& one : surveys) {
    for (ResidualSurvey& other : surveys) {
      if (one.frequency >= other.frequency) continue;
      const double as_is = one.spread_m / one.ambiguity_m * other.spread_m / other.ambiguity_m;
      const double exchanged = relative_spread(frames, sensor, one.frequency, other.frequency) *
                               relative_spread(frames, sensor, other.frequency, one.frequency);
      if (!(exchanged < telling_ratio * telling_ratio * as_is)) continue;
      one.exchanged_with = other.frequency;
      other.exchanged_with = one.frequency;
    }
  }
}

}  // namespace

std::vector<ResidualSurvey> survey_residuals(const std::vector<Frame>& frames,
                                             const SensorModel& sensor) {
  std::vector<ResidualSurvey> surveys;
  for (std::size_t b = 1; b < sensor.modulation.count(); ++b) {
    auto survey = survey_pair(frames, sensor, b);
    if (survey) surveys.push_back(*std::move(survey));
  }
  find_exchanged(frames, sensor, surveys);
  return surveys;
}

std::optional<std::string> pairing_warning(const ResidualSurvey& residual, bool map_agrees) {
  if (residual.exchanged_with > 0) {
    return fmt::format(
        "{} and {} agree with A only if they are exchanged; are their frequencies mixed up in "
        "sequence.yaml, or their folders?",
        frequency_name(residual.frequency), frequency_name(residual.exchanged_with));
  }
  if (residual.swapped_spread_m < telling_ratio * residual.spread_m) {
    return fmt::format(
        "A and {0} agree within {1:.0f} mm if the frequencies are swapped, but only within {2:.0f} "
        "mm "
        "as they are; are the frequencies of A and {0} mixed up in sequence.yaml, or their "
        "folders?",
        frequency_name(residual.frequency), 1000 * residual.swapped_spread_m,
        1000 * residual.spread_m);
  }
  // Differences of unrelated phases have a spread of 0.37 times the ambiguity, or more if
  // max_range_m is small.
  constexpr double no_agreement = 0.3;
  if (!map_agrees && residual.spread_m > no_agreement * residual.ambiguity_m) {
    return fmt::format(
        "A and {} agree only within {:.0f} mm, no better than images of different places; are "
        "their folders or files mixed up, is max_range_m less than the size of the room, is "
        "device.layout wrong for the device, or do the images show nothing but noise?",
        frequency_name(residual.frequency), 1000 * residual.spread_m);
  }
  return std::nullopt;
}

std::optional<std::string> offset_warning(const ResidualSurvey& residual,
                                          const CameraErrors* camera, bool map_agrees) {
  constexpr double least_m = 0.02;  // motion between the exposures causes some millimetres
  // The two estimates use different pixels and frames. If the frames agree on a map, both are of
  // the same wrap counts, and noise alone makes them differ.
  const double same_m = map_agrees ? residual.ambiguity_m / 4 : 0.03;
  const bool is_known = camera != nullptr && camera->frames > 0;
  const double estimate_m = is_known ? camera->offset_m() : residual.offset_m;
  const bool agree = std::abs(estimate_m - residual.offset_m) < same_m;
  if (std::max(std::abs(estimate_m), std::abs(residual.offset_m)) < least_m) return std::nullopt;
  const std::string remedy =
      "; 'tofmap calibrate' with known ranges finds the phase offset of each frequency";
  if (!agree) {
    return "the offset between the frequencies is uncertain: A measures " +
           more_or_less(estimate_m) + " than " + frequency_name(residual.frequency) + ", or " +
           offset_text(residual) + remedy;
  }
  // The next offsets that fit are about `ambiguity_m` away, and so at least three times as large.
  const bool is_smallest_by_far = std::abs(estimate_m) < residual.ambiguity_m / 4;
  if (is_known && (is_smallest_by_far || map_agrees)) return std::nullopt;
  return "A measures " + offset_text(residual) + remedy;
}

std::optional<std::string> frequency_warning(const SensorModel& sensor, double max_range_m) {
  constexpr double least_wavelengths = 1.5;
  const Modulation& modulation = sensor.modulation;
  if (modulation.count() == 1 && are_absolute(unwrap_limits(sensor, max_range_m))) {
    return std::nullopt;
  }
  const double combined_m = combined_range_m(modulation);
  const double shortest_m = shortest_wavelength_m(modulation);
  if (combined_m >= least_wavelengths * shortest_m) return std::nullopt;
  if (modulation.count() == 1) {
    return fmt::format(
        "one frequency cannot tell wrap counts apart: ranges are unambiguous up to {:.2f} m, and "
        "those beyond are known only relative to their neighbours",
        combined_m);
  }
  return fmt::format(
      "these frequencies cannot tell wrap counts apart: together they are unambiguous up to "
      "{:.2f} m, and one alone up to {:.2f} m; are the frequencies right?",
      combined_m, shortest_m);
}

std::optional<std::string> order_warning(const Modulation& modulation) {
  const double first_m = modulation.wavelength_m(0);
  if (first_m <= telling_wavelength_ratio * shortest_wavelength_m(modulation)) return std::nullopt;
  return fmt::format(
      "the wavelength of the first frequency, {:.2f} m, is more than twice the shortest: "
      "motion and systematic errors are estimated relative to the first frequency, and less "
      "precisely than with a shorter wavelength first",
      first_m);
}

}  // namespace tofmap

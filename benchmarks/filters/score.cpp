// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "score.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <tofmap/core/median.hpp>
#include <tofmap/simulation/pixel_label.hpp>

namespace tofmap::bench {
namespace {

/// The median of values. NaN if there are none.
double median_of(std::vector<float> values) {
  return values.empty() ? std::nan("") : median(values);
}

/// Adds a pixel that sees one surface and has the right wrap count to the score.
void tally_one_surface(const Sample& sample, const RangeImage& kept, Eigen::Index v, Eigen::Index u,
                       Score& score) {
  const SimulatedFrame& truth = sample.simulated;
  const double truth_m = truth.range_truth_m(v, u);
  const bool is_removed = !kept.valid(v, u);
  if (!is_removed) {
    const double before_m = sample.unwrapped.range_m(v, u) - truth_m;
    const double after_m = kept.range_m(v, u) - truth_m;
    score.squared_before_m2 += before_m * before_m;
    score.squared_after_m2 += after_m * after_m;
    score.one_surface_kept += 1;
    score.before_m.push_back(static_cast<float>(std::abs(before_m)));
    score.after_m.push_back(static_cast<float>(std::abs(after_m)));
  }
  if (static_cast<PixelLabel>(truth.label(v, u)) != PixelLabel::right) return;
  const double angle_deg = std::acos(truth.cos_incidence(v, u)) * 180 / std::numbers::pi;
  const auto angle = std::min(Score::angles - 1, static_cast<std::size_t>(angle_deg));
  const auto range = std::min(Score::ranges - 1, static_cast<std::size_t>(truth_m));
  score.lost_by_angle[angle].add(is_removed);
  score.lost_by_range[range].add(is_removed);
}

void tally(const Sample& sample, const RangeImage& kept, Score& score) {
  constexpr double wrong_m = 2;  // a larger error is a wrong wrap
  const ImageF& truth_m = sample.simulated.range_truth_m;
  for (Eigen::Index v = 0; v < kept.rows(); ++v) {
    for (Eigen::Index u = 0; u < kept.cols(); ++u) {
      if (!sample.unwrapped.valid(v, u)) continue;
      const bool is_removed = !kept.valid(v, u);
      if (is_flying(sample, v, u)) score.found.add(is_removed);
      if (is_labelled_flying(sample, v, u)) score.found_by_label.add(is_removed);
      if (is_removed) score.precise.add(sees_several_surfaces(sample, v, u));
      if (sees_several_surfaces(sample, v, u) || std::isnan(truth_m(v, u))) continue;
      if (std::abs(sample.unwrapped.range_m(v, u) - truth_m(v, u)) > wrong_m) continue;
      tally_one_surface(sample, kept, v, u, score);
    }
  }
}

}  // namespace

Share Score::lost_between(std::size_t from_deg, std::size_t to_deg) const {
  Share sum;
  for (std::size_t bin = from_deg; bin < to_deg; ++bin) sum.add(lost_by_angle[bin]);
  return sum;
}

Share Score::lost_beyond_far() const {
  Share sum;
  for (auto bin = static_cast<std::size_t>(far_m); bin < ranges; ++bin) sum.add(lost_by_range[bin]);
  return sum;
}

double Score::rmse_m() const { return std::sqrt(squared_after_m2 / one_surface_kept); }

double Score::rms_share() const { return std::sqrt(squared_after_m2 / squared_before_m2); }

double Score::median_share() const { return median_of(after_m) / median_of(before_m); }

Score score_filter(const MeasuredFilter& filter, const Case& example) {
  Score score;
  for (const Sample& sample : example.samples) {
    const auto start = std::chrono::steady_clock::now();
    const RangeImage kept = filter.apply(example, sample);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    score.milliseconds += time.count() / static_cast<double>(example.samples.size());
    tally(sample, kept, score);
  }
  return score;
}

Score joined(const std::vector<Score>& scores) {
  Score sum;
  for (const Score& score : scores) {
    sum.found.add(score.found);
    sum.found_by_label.add(score.found_by_label);
    sum.precise.add(score.precise);
    for (std::size_t i = 0; i < Score::angles; ++i)
      sum.lost_by_angle[i].add(score.lost_by_angle[i]);
    for (std::size_t i = 0; i < Score::ranges; ++i)
      sum.lost_by_range[i].add(score.lost_by_range[i]);
    sum.squared_before_m2 += score.squared_before_m2;
    sum.squared_after_m2 += score.squared_after_m2;
    sum.one_surface_kept += score.one_surface_kept;
    sum.before_m.insert(sum.before_m.end(), score.before_m.begin(), score.before_m.end());
    sum.after_m.insert(sum.after_m.end(), score.after_m.begin(), score.after_m.end());
    sum.milliseconds += score.milliseconds / static_cast<double>(scores.size());
  }
  return sum;
}

}  // namespace tofmap::bench

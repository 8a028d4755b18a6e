// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/evaluation/range_score.hpp"

#include <cmath>
#include <limits>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double share_percent(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0; }

}  // namespace

RangeScore score_ranges(const RangeImage& image, const ImageF& truth_m, double wavelength_a_m) {
  if (!same_size(image.range_m, truth_m)) {
    throw UsageError("ranges and truth differ in size");
  }
  const auto no_return = static_cast<std::uint8_t>(InvalidReason::no_return);
  int expected = 0;
  int present = 0;
  int wrong = 0;
  double sum = 0;
  for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
    const float truth = truth_m.data()[i];
    if (std::isnan(truth) || image.reason.data()[i] == no_return) continue;
    ++expected;
    if (image.reason.data()[i] != 0) continue;
    ++present;
    const double error = image.range_m.data()[i] - truth;
    if (std::abs(error) > wavelength_a_m / 2) {
      ++wrong;
    } else {
      sum += error * error;
    }
  }
  RangeScore score;
  score.wrong_wrap_percent = share_percent(wrong, present);
  score.coverage_percent = share_percent(present, expected);
  score.range_rmse_m = present > wrong ? std::sqrt(sum / (present - wrong)) : nan;
  return score;
}

RangeScore mean_score(const std::vector<RangeScore>& frames) {
  RangeScore mean;
  int with_rmse = 0;
  for (const RangeScore& frame : frames) {
    mean.wrong_wrap_percent += frame.wrong_wrap_percent / static_cast<double>(frames.size());
    mean.coverage_percent += frame.coverage_percent / static_cast<double>(frames.size());
    if (std::isnan(frame.range_rmse_m)) continue;
    mean.range_rmse_m += frame.range_rmse_m;
    ++with_rmse;
  }
  mean.range_rmse_m = with_rmse > 0 ? mean.range_rmse_m / with_rmse : nan;
  return mean;
}

}  // namespace tofmap

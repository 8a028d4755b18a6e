// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "conditions.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tofmap::accuracy {
namespace {

constexpr double standard_errors = 3;

/// The numbers of pixels and of wrong pixels.
struct Tally {
  double wrong = 0;
  double pixels = 0;

  double percent() const { return pixels > 0 ? 100 * wrong / pixels : 0; }
};

using TallyOf = std::function<Tally(const FrameScore&)>;

Tally all_pixels(const FrameScore& frame) { return {frame.wrong, frame.pixels}; }
Tally sure_pixels(const FrameScore& frame) { return {frame.sure_wrong, frame.sure}; }

/// The standard error, from counting, of the difference between `value` and `factor` times
/// `reference`.
double counting_error_percent(const Tally& value, const Tally& reference, double factor) {
  const double pixels = std::max({1.0, value.pixels, reference.pixels});
  return 100 * std::sqrt(value.wrong + factor * factor * reference.wrong) / pixels;
}

/// The standard error of the mean of values. 0 for fewer than two.
double standard_error(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  if (count < 2) return 0;
  double sum = 0;
  for (const double value : values) sum += value;
  double squares = 0;
  for (const double value : values) squares += (value - sum / count) * (value - sum / count);
  return std::sqrt(squares / (count - 1) / count);
}

/// Compares the mean of `value` over frames with `factor` times the mean of `reference`.
Check compare_means(const Score& value, const Score& reference, double factor,
                    const TallyOf& tally_of) {
  Check check{.applies = true};
  std::vector<double> differences;
  Tally value_sum;
  Tally reference_sum;
  const std::size_t frames = std::min(value.frames.size(), reference.frames.size());
  for (std::size_t i = 0; i < frames; ++i) {
    const Tally a = tally_of(value.frames[i]);
    const Tally b = tally_of(reference.frames[i]);
    check.value += a.percent() / static_cast<double>(frames);
    check.limit += factor * b.percent() / static_cast<double>(frames);
    differences.push_back(a.percent() - factor * b.percent());
    value_sum = {value_sum.wrong + a.wrong, value_sum.pixels + a.pixels};
    reference_sum = {reference_sum.wrong + b.wrong, reference_sum.pixels + b.pixels};
  }
  check.allowance =
      standard_errors * std::max(standard_error(differences),
                                 counting_error_percent(value_sum, reference_sum, factor));
  return check;
}

Tally worst_frame(const Score& score) {
  Tally worst;
  for (const FrameScore& frame : score.frames) {
    if (all_pixels(frame).percent() >= worst.percent()) worst = all_pixels(frame);
  }
  return worst;
}

Check compare_worst(const Score& value, const Score& reference, double factor) {
  const Tally a = worst_frame(value);
  const Tally b = worst_frame(reference);
  return {.applies = true,
          .value = a.percent(),
          .limit = factor * b.percent(),
          .allowance = standard_errors * counting_error_percent(a, b, factor)};
}

/// Compares the calibration error with 1 %.
Check check_calibration(const Score& score) {
  const auto frames = static_cast<double>(score.frames.size());
  std::vector<double> errors;
  for (const FrameScore& frame : score.frames) {
    errors.push_back(frames * score.calibration.error_percent_of(frame.calibration));
  }
  return {.applies = true,
          .value = score.calibration.error_percent(),
          .limit = 1,
          .allowance = standard_errors * standard_error(errors)};
}

}  // namespace

const char* name_of(Condition condition) {
  switch (condition) {
    case Condition::no_worse_than_simple:
      return "mean at most that of the better of pixel and jump";
    case Condition::mean_kept:
      return "mean at most 1.3 times that without the errors";
    case Condition::worst_kept:
      return "worst frame at most twice that without the errors";
    case Condition::surest_kept:
      return "surest 90 %: at most twice those without the errors";
    case Condition::calibrated:
      return "calibration error at most 1 %";
  }
  return "";
}

Checks check_row(const Grid& grid, const GridRow& row) {
  const Score& better = row.pixel.wrong_percent() < row.jump.wrong_percent() ? row.pixel : row.jump;
  Checks checks;
  checks[0] = compare_means(row.joint, better, 1, all_pixels);
  const CameraErrors& errors = grid.errors_of(row);
  if (!errors.has_ambient() && !errors.are_none()) {
    const Score& reference = row.joint_without_errors;
    checks[1] = compare_means(row.joint, reference, 1.3, all_pixels);
    checks[2] = compare_worst(row.joint, reference, 2);
    checks[3] = compare_means(row.joint, reference, 2, sure_pixels);
  }
  checks[4] = check_calibration(row.joint);
  return checks;
}

}  // namespace tofmap::accuracy

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/evaluation/range_score.hpp"

#include <cmath>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

double share_percent(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : nan;
}

/// A pixel with a return and a known truth.
struct PixelError {
  double truth_m = 0;
  bool has_range = false;
  bool is_wrong = false;  ///< off by more than half a wavelength
  double error_m = 0;
};

template <class Visit>
void for_each_expected(const RangeImage& image, const ImageF& truth_m, double wavelength_a_m,
                       const Visit& visit) {
  if (!same_size(image.range_m, truth_m)) {
    throw UsageError("ranges and truth differ in size");
  }
  const auto no_return = static_cast<std::uint8_t>(InvalidReason::no_return);
  for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
    const float truth = truth_m.data()[i];
    if (!(truth >= 0) || std::isinf(truth) || image.reason.data()[i] == no_return) continue;
    PixelError pixel;
    pixel.truth_m = truth;
    pixel.has_range = image.reason.data()[i] == 0;
    if (pixel.has_range) {
      pixel.error_m = image.range_m.data()[i] - truth;
      pixel.is_wrong = std::abs(pixel.error_m) > wavelength_a_m / 2;
    }
    visit(pixel);
  }
}

}  // namespace

RangeScore score_ranges(const RangeImage& image, const ImageF& truth_m, double wavelength_a_m) {
  int expected = 0;
  int present = 0;
  int wrong = 0;
  double sum = 0;
  for_each_expected(image, truth_m, wavelength_a_m, [&](const PixelError& pixel) {
    ++expected;
    if (!pixel.has_range) return;
    ++present;
    wrong += pixel.is_wrong ? 1 : 0;
    sum += pixel.is_wrong ? 0 : pixel.error_m * pixel.error_m;
  });
  RangeScore score;
  score.wrong_wrap_percent = share_percent(wrong, present);
  score.coverage_percent = share_percent(present, expected);
  score.range_rmse_m = present > wrong ? std::sqrt(sum / (present - wrong)) : nan;
  return score;
}

RangeScore mean_score(const std::vector<RangeScore>& frames) {
  const auto mean_of = [&](double RangeScore::*value) {
    double sum = 0;
    int count = 0;
    for (const RangeScore& frame : frames) {
      if (std::isnan(frame.*value)) continue;
      sum += frame.*value;
      ++count;
    }
    return count > 0 ? sum / count : nan;
  };
  return {mean_of(&RangeScore::wrong_wrap_percent), mean_of(&RangeScore::coverage_percent),
          mean_of(&RangeScore::range_rmse_m)};
}

void ErrorsOverRange::add(const RangeImage& image, const ImageF& truth_m, double wavelength_a_m) {
  for_each_expected(image, truth_m, wavelength_a_m, [&](const PixelError& pixel) {
    if (!pixel.has_range) return;
    const auto bin = static_cast<std::size_t>(pixel.truth_m / bin_m);
    if (sums_.size() <= bin) sums_.resize(bin + 1);
    Sums& sums = sums_[bin];
    ++sums.pixels;
    sums.wrong += pixel.is_wrong ? 1 : 0;
    sums.square_m2 += pixel.is_wrong ? 0 : pixel.error_m * pixel.error_m;
  });
}

void ErrorsOverRange::add(const ErrorsOverRange& others) {
  if (sums_.size() < others.sums_.size()) sums_.resize(others.sums_.size());
  for (std::size_t i = 0; i < others.sums_.size(); ++i) {
    sums_[i].pixels += others.sums_[i].pixels;
    sums_[i].wrong += others.sums_[i].wrong;
    sums_[i].square_m2 += others.sums_[i].square_m2;
  }
}

std::vector<ErrorsOverRange::Bin> ErrorsOverRange::bins() const {
  std::vector<Bin> bins;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Sums& sums = sums_[i];
    if (sums.pixels == 0) continue;
    const std::int64_t right = sums.pixels - sums.wrong;
    bins.push_back({(static_cast<double>(i) + 0.5) * bin_m, sums.pixels,
                    share_percent(sums.wrong, sums.pixels),
                    right > 0 ? std::sqrt(sums.square_m2 / static_cast<double>(right)) : nan});
  }
  return bins;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scores.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tofmap::accuracy {
namespace {

struct Pixel {
  float confidence;
  bool is_wrong;
};

double count_wrong(const std::vector<Pixel>& pixels, std::size_t first) {
  const auto end = pixels.begin() + static_cast<std::ptrdiff_t>(first);
  return static_cast<double>(
      std::count_if(pixels.begin(), end, [](Pixel p) { return p.is_wrong; }));
}

template <class Value>
double mean_over(const std::vector<FrameScore>& frames, const Value& value) {
  double sum = 0;
  for (const FrameScore& frame : frames) sum += value(frame);
  return frames.empty() ? 0 : sum / static_cast<double>(frames.size());
}

}  // namespace

void Calibration::add(float confidence, bool is_right) {
  const auto bin = std::min(static_cast<std::size_t>(confidence * bins), bins - 1);
  confidence_[bin] += confidence;
  right_[bin] += is_right ? 1 : 0;
  all_ += 1;
  const auto above = std::upper_bound(limits.begin(), limits.end(), double{confidence});
  Tally& tally = tallies_[static_cast<std::size_t>(above - limits.begin() - 1)];
  tally.pixels += 1;
  tally.confidence += confidence;
  tally.right += is_right ? 1 : 0;
}

void Calibration::add(const Calibration& other) {
  for (std::size_t b = 0; b < bins; ++b) {
    confidence_[b] += other.confidence_[b];
    right_[b] += other.right_[b];
  }
  all_ += other.all_;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    tallies_[k].pixels += other.tallies_[k].pixels;
    tallies_[k].confidence += other.tallies_[k].confidence;
    tallies_[k].right += other.tallies_[k].right;
  }
}

double Calibration::error_percent() const {
  double sum = 0;
  for (std::size_t b = 0; b < bins; ++b) sum += std::abs(confidence_[b] - right_[b]);
  return all_ > 0 ? 100 * sum / all_ : 0;
}

double Calibration::error_percent_of(const Calibration& some) const {
  double sum = 0;
  for (std::size_t b = 0; b < bins; ++b) {
    const double excess = some.confidence_[b] - some.right_[b];
    sum += confidence_[b] > right_[b] ? excess : -excess;
  }
  return all_ > 0 ? 100 * sum / all_ : 0;
}

std::vector<Calibration::Bin> Calibration::reliability() const {
  std::vector<Bin> out;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    const Tally& tally = tallies_[k];
    if (tally.pixels == 0) continue;
    out.push_back({limits[k], tally.confidence / tally.pixels, tally.right / tally.pixels,
                   tally.pixels / all_});
  }
  return out;
}

double Score::wrong_percent() const {
  return mean_over(frames, [](const FrameScore& f) { return f.wrong_percent(); });
}

double Score::worst_percent() const {
  double worst = 0;
  for (const FrameScore& frame : frames) worst = std::max(worst, frame.wrong_percent());
  return worst;
}

double Score::sure_wrong_percent() const {
  return mean_over(frames, [](const FrameScore& f) { return f.sure_wrong_percent(); });
}

double Score::coverage_percent() const {
  return mean_over(frames,
                   [](const FrameScore& f) { return 100 * f.pixels / std::max(1.0, f.returns); });
}

double Score::range_rmse_m() const {
  return mean_over(frames, [](const FrameScore& f) {
    return std::sqrt(f.square_error_m2 / std::max(1.0, f.pixels - f.wrong));
  });
}

double Score::converged_percent() const {
  return mean_over(frames, [](const FrameScore& f) { return f.is_converged ? 100.0 : 0.0; });
}

double Score::milliseconds() const {
  return mean_over(frames, [](const FrameScore& f) { return f.milliseconds; });
}

void add_frame(const Frame& frame, const RangeImage& image, const ImageF& truth_m,
               double wavelength_a_m, Score& score) {
  std::vector<Pixel> pixels;
  FrameScore added;
  for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
    const bool has_return = !std::isnan(frame.phases[0].data()[i] + frame.phases[1].data()[i]);
    if (!has_return || std::isnan(truth_m.data()[i])) continue;
    added.returns += 1;
    if (image.reason.data()[i] != 0) continue;
    const double error_m = std::abs(image.range_m.data()[i] - truth_m.data()[i]);
    const bool is_wrong = error_m > wavelength_a_m / 2;
    if (!is_wrong) added.square_error_m2 += error_m * error_m;
    pixels.push_back({image.confidence.data()[i], is_wrong});
    added.calibration.add(image.confidence.data()[i], !is_wrong);
  }
  score.calibration.add(added.calibration);
  added.pixels = static_cast<double>(pixels.size());
  added.wrong = count_wrong(pixels, pixels.size());
  std::ranges::stable_sort(pixels, std::ranges::greater(), &Pixel::confidence);
  const auto sure = std::min(static_cast<std::size_t>(0.9 * added.returns), pixels.size());
  added.sure = static_cast<double>(sure);
  added.sure_wrong = count_wrong(pixels, sure);
  score.frames.push_back(added);
}

void add_score(const Score& other, Score& score) {
  score.frames.insert(score.frames.end(), other.frames.begin(), other.frames.end());
  score.calibration.add(other.calibration);
}

}  // namespace tofmap::accuracy

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/isolated_wrap_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include <tofmap/core/error.hpp>
#include <tofmap/core/frequency_residual.hpp>

namespace tofmap {
namespace {

struct Pixel {
  int row;
  int col;
};

/// Two neighbours, one in a region and one outside it.
struct BorderPair {
  Pixel inside;
  Pixel outside;
};

struct Region {
  std::vector<Pixel> pixels;
  std::vector<BorderPair> border;
};

/// Finds regions: 4-connected valid pixels without a step of half a wavelength between neighbours.
class RegionFinder {
 public:
  RegionFinder(const RangeImage& image, double wavelength_m)
      : image_(image),
        max_step_m_(static_cast<float>(wavelength_m / 2)),
        is_seen_(Image<bool>::Constant(image.rows(), image.cols(), false)) {}

  bool is_seen(int row, int col) const { return is_seen_(row, col); }

  /// The region that contains a valid pixel. All of its pixels are marked as seen. The reference is
  /// valid until the next call.
  const Region& find(int row, int col) {
    region_.pixels.clear();
    region_.border.clear();
    visit({row, col});
    for (std::size_t next = 0; next < region_.pixels.size(); ++next) {
      const Pixel at = region_.pixels[next];
      for (const Pixel to : {Pixel{at.row, at.col + 1}, Pixel{at.row + 1, at.col},
                             Pixel{at.row, at.col - 1}, Pixel{at.row - 1, at.col}}) {
        if (!is_valid(to)) continue;
        if (step_m(at, to) >= max_step_m_) {
          region_.border.push_back({at, to});
        } else if (!is_seen_(to.row, to.col)) {
          visit(to);
        }
      }
    }
    return region_;
  }

 private:
  bool is_valid(Pixel at) const {
    return at.row >= 0 && at.row < image_.rows() && at.col >= 0 && at.col < image_.cols() &&
           image_.valid(at.row, at.col);
  }

  float step_m(Pixel from, Pixel to) const {
    return std::abs(image_.range_m(to.row, to.col) - image_.range_m(from.row, from.col));
  }

  void visit(Pixel at) {
    is_seen_(at.row, at.col) = true;
    region_.pixels.push_back(at);
  }

  const RangeImage& image_;
  float max_step_m_;
  Image<bool> is_seen_;
  Region region_;
};

/// What the surroundings of a region vote for.
struct Vote {
  int wraps = 0;         ///< wraps to be added to the region
  float confidence = 0;  ///< mean confidence of the pixels outside that voted
};

/// How many wavelengths must be added to a region so that it fits its surroundings. Empty unless
/// more than half of its border agrees.
std::optional<Vote> vote(const Region& region, const RangeImage& image, double wavelength_m) {
  constexpr double tolerated_wavelengths = 1.0 / 16;  // for the slant between two pixels
  constexpr double tolerated_sigmas = 3;
  struct Ballot {
    int pairs = 0;
    float confidence = 0;
  };
  std::map<int, Ballot> ballots;
  for (const auto& [in, out] : region.border) {
    const double step_m = image.range_m(out.row, out.col) - image.range_m(in.row, in.col);
    const double error_m =
        std::sqrt(image.variance_m2(in.row, in.col) + image.variance_m2(out.row, out.col));
    const double wraps = std::round(step_m / wavelength_m);
    const double tolerated_m = tolerated_wavelengths * wavelength_m + tolerated_sigmas * error_m;
    if (std::abs(step_m - wraps * wavelength_m) > tolerated_m) continue;
    Ballot& ballot = ballots[static_cast<int>(wraps)];
    ++ballot.pairs;
    ballot.confidence += image.confidence(out.row, out.col);
  }
  for (const auto& [wraps, ballot] : ballots) {
    if (2 * ballot.pairs > static_cast<int>(region.border.size())) {
      return Vote{wraps, ballot.confidence / static_cast<float>(ballot.pairs)};
    }
  }
  return std::nullopt;
}

/// Smallest difference of costs, in nats, that decides: that of three standard deviations at one
/// pixel. It also limits the cost of a single pixel, so that no pixel outvotes a region.
constexpr double sure_nats = 4.5;

/// How badly the residuals fit a region if `change` is added to all of its wrap counts: the sum
/// over its pixels of half the squared residual over its variance (docs/filters.md, equation 1).
double residual_cost(const Region& region, int change, const RangeImage& image, const Frame& frame,
                     const Modulation& modulation) {
  const double mean_m = mean_wavelength_m(modulation);  // range_m is the mean of all frequencies
  double sum = 0;
  for (const Pixel at : region.pixels) {
    const double a_cycles =
        frame.phases[0](at.row, at.col) + image.wrap_count(at.row, at.col) + change;
    const double phase_variance = image.variance_m2(at.row, at.col) / (mean_m * mean_m);
    for (std::size_t f = 1; f < frame.frequencies(); ++f) {
      const double b_per_a = modulation.frequencies_hz[f] / modulation.frequencies_hz[0];
      const double residual =
          frequency_residual_cycles(static_cast<float>(a_cycles), frame.phases[f](at.row, at.col),
                                    static_cast<float>(b_per_a));
      const double variance = phase_variance * (1 + b_per_a * b_per_a);
      sum += std::min(sure_nats, residual * residual / (2 * variance));
    }
  }
  return sum;
}

/// Whether all wrap counts stay valid if `change` is added to them.
bool allows(const Region& region, int change, const RangeImage& image) {
  return std::ranges::all_of(region.pixels, [&](const Pixel at) {
    const int count = image.wrap_count(at.row, at.col) + change;
    return count >= 0 && count < invalid_wrap_count;
  });
}

/// Gives a region the wrap counts of its surroundings, and the ranges of A.
void correct(const Region& region, const Vote& vote, const Frame& frame,
             const Modulation& modulation, RangeImage& image) {
  const double wavelength_m = modulation.wavelength_m(0);
  const auto noise_of_a = static_cast<float>(wavelength_m / mean_wavelength_m(modulation));
  for (const Pixel at : region.pixels) {
    const int count = image.wrap_count(at.row, at.col) + vote.wraps;
    image.wrap_count(at.row, at.col) = static_cast<std::uint8_t>(count);
    image.range_m(at.row, at.col) =
        static_cast<float>((frame.phases[0](at.row, at.col) + count) * wavelength_m);
    image.sigma_m(at.row, at.col) *= noise_of_a;
    image.confidence(at.row, at.col) = vote.confidence;
  }
}

/// Corrects or drops a region if it is an isolated wrap.
void mend(const Region& region, const Frame& frame, const Modulation& modulation,
          const RangeImage& image, RangeImage& out) {
  const double wavelength_m = modulation.wavelength_m(0);
  const std::optional<Vote> surroundings = vote(region, image, wavelength_m);
  if (!surroundings) return;
  const auto cost = [&](int change) {
    return residual_cost(region, change, image, frame, modulation);
  };
  const int change = surroundings->wraps;
  const double own = cost(0);
  const double theirs =
      allows(region, change, image) ? cost(change) : std::numeric_limits<double>::infinity();
  constexpr std::array near_counts{-2, -1, 1, 2};
  const bool fits_a_third = std::ranges::any_of(near_counts, [&](int other) {
    return other != change && allows(region, other, image) &&
           cost(other) + sure_nats < std::min(own, theirs);
  });
  if (fits_a_third) {
    for (const Pixel at : region.pixels) {
      out.invalidate(at.row, at.col, InvalidReason::isolated_wrap);
    }
  } else if (theirs < own + sure_nats) {
    correct(region, *surroundings, frame, modulation, out);
  }
}

bool has_wraps(const RangeImage& image) {
  return (image.wrap_count > 0 && image.wrap_count != invalid_wrap_count).any();
}

}  // namespace

RangeImage mend_isolated_wraps(const RangeImage& image, const Frame& frame,
                               const Modulation& modulation, const IsolatedWrapLimits& limits) {
  const auto fits = [&](const ImageF& phase) { return same_size(image.range_m, phase); };
  if (frame.phases.empty() || !std::ranges::all_of(frame.phases, fits)) {
    throw UsageError("isolated-wrap filter: range image and frame differ in size");
  }
  RangeImage out = image;
  if (!has_wraps(image)) return out;
  const double max_pixels = limits.max_share * static_cast<double>(image.range_m.size());
  RegionFinder finder(image, modulation.wavelength_m(0));
  for (int row = 0; row < image.rows(); ++row) {
    for (int col = 0; col < image.cols(); ++col) {
      if (!image.valid(row, col) || finder.is_seen(row, col)) continue;
      const Region& region = finder.find(row, col);
      if (static_cast<double>(region.pixels.size()) > max_pixels) continue;
      mend(region, frame, modulation, image, out);
    }
  }
  return out;
}

}  // namespace tofmap

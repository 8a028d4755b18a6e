// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/plane_edge_filter.hpp"

#include "surface_agreement.hpp"

#include <cstddef>
#include <utility>

namespace tofmap {
namespace {

constexpr auto directions = static_cast<std::size_t>(Neighbourhood::directions);

/// Decides which pixels of one image are kept.
class SurfaceKeeper {
 public:
  /// The first pass: keeps valid pixels that lie on a surface or on a strip.
  SurfaceKeeper(const RangeImage& image, Depths depths, const AgreementLimits& limits)
      : depths_(std::move(depths)),
        agreement_(depths_, limits),
        noise2_(static_cast<float>(limits.edge_sigmas * limits.edge_sigmas)),
        tolerance2_(static_cast<float>(limits.tolerance_m * limits.tolerance_m)),
        kept_(Image<bool>::Constant(image.rows(), image.cols(), false)) {
    for_each(image.reason == 0, [&](int row, int col) {
      return agreement_.lies_on_surface(row, col) || lies_on_a_strip(row, col, Neighbourhood::all);
    });
  }

  /// The second pass: drops kept pixels at steps that agree only with pixels that are not kept.
  void drop_what_flying_pixels_keep() {
    const Image<bool> before = kept_;
    for_each(before, [&](int row, int col) {
      if (!agreement_.is_at_step(row, col)) return true;
      const unsigned among = kept_neighbours(before, row, col);
      return agreement_.lies_on_surface(row, col, among) || lies_on_a_strip(row, col, among);
    });
  }

  /// The last pass: restores valid pixels that have the same depth as two kept neighbours.
  void take_back(const RangeImage& image) {
    const Image<bool> before = kept_;
    for_each(image.reason == 0, [&](int row, int col) {
      return before(row, col) || is_as_deep_as_two(before, row, col);
    });
  }

  const Image<bool>& kept() const { return kept_; }

 private:
  /// Sets `kept_` to says(row, col) for all pixels for which `candidates` is true.
  template <class Candidates, class Says>
  void for_each(const Candidates& candidates, const Says& says) {
    for (int row = 0; row < depths_.own.rows(); ++row) {
      for (int col = 0; col < depths_.own.cols(); ++col) {
        if (candidates(row, col)) kept_(row, col) = says(row, col);
      }
    }
  }

  /// One bit for each direction whose neighbour is kept. Neighbours outside the image count as
  /// kept.
  unsigned kept_neighbours(const Image<bool>& kept, int row, int col) const {
    unsigned bits = Neighbourhood::all;
    for (std::size_t d = 0; d < directions; ++d) {
      const int v = row + Neighbourhood::rows[d];
      const int u = col + Neighbourhood::cols[d];
      if (is_inside(v, u) && !kept(v, u)) bits &= ~(1U << d);
    }
    return bits;
  }

  bool is_inside(int row, int col) const {
    return row >= 0 && col >= 0 && row < depths_.own.rows() && col < depths_.own.cols();
  }

  /// Whether a pixel and a neighbour lie on two parallel lines of the same depth: on a strip that
  /// is two pixels wide.
  bool lies_on_a_strip(int row, int col, unsigned among) const {
    const unsigned lines = agreement_.lines(row, col) & among & among >> Neighbourhood::axes;
    if (lines == 0) return false;
    for (std::size_t d = 0; d < directions; ++d) {
      const unsigned along = 1U << d % Neighbourhood::axes;  // the line through both pixels
      const unsigned beside =
          agreement_.lines(row + Neighbourhood::rows[d], col + Neighbourhood::cols[d]);
      if ((lines & beside & ~along) == 0 || (among >> d & 1U) == 0) continue;
      if (is_as_deep(row, col, d)) return true;
    }
    return false;
  }

  bool is_as_deep_as_two(const Image<bool>& kept, int row, int col) const {
    int count = 0;
    for (std::size_t d = 0; d < directions; ++d) {
      const int v = row + Neighbourhood::rows[d];
      const int u = col + Neighbourhood::cols[d];
      if (is_inside(v, u) && kept(v, u) && is_as_deep(row, col, d)) ++count;
    }
    return count >= 2;
  }

  /// Whether a pixel and its neighbour have the same depth, both by the range from both frequencies
  /// and by that from A alone.
  bool is_as_deep(int row, int col, std::size_t direction) const {
    const int to = col + Neighbourhood::offset(direction, depths_.own.stride());
    const float depth_m = 1 / depths_.own.value(row)[col] - 1 / depths_.smooth.value(row)[to];
    const float variance = depths_.own.variance(row)[col] + depths_.smooth.variance(row)[to];
    const FrequencyDifference& difference = depths_.difference;
    const float difference_m = difference.value(row)[col] - difference.value(row)[to];
    const float difference_variance = difference.variance(row)[col] + difference.variance(row)[to];
    const float a_m = depth_m + 0.5F * difference_m;
    return depth_m * depth_m <= tolerance2_ + noise2_ * variance &&
           a_m * a_m <= tolerance2_ + noise2_ * (variance + 0.25F * difference_variance);
  }

  Depths depths_;
  SurfaceAgreement agreement_;
  float noise2_;
  float tolerance2_;
  Image<bool> kept_;
};

}  // namespace

RangeImage drop_off_planes(const RangeImage& image, const Frame& frame,
                           const Modulation& modulation, const PixelRays& rays,
                           const PlaneEdgeLimits& limits) {
  // The limits are stricter than those for smoothing: a pixel that is left out without need only
  // adds noise, but a pixel that is included wrongly displaces predictions.
  constexpr PairAverage average{.max_sigmas = 2.5, .tolerance_m = 0.005};
  const InverseDepth depth(image, rays);
  SurfaceKeeper keeper(image,
                       {depth, averaged_over_pairs(depth, average),
                        FrequencyDifference(image, frame, modulation, rays)},
                       {.plane_sigmas = limits.max_sigmas,
                        .edge_sigmas = limits.max_edge_sigmas,
                        .tolerance_m = limits.tolerance_m,
                        .mixing_m = modulation.wavelength_m(0) / 4});
  keeper.drop_what_flying_pixels_keep();
  keeper.take_back(image);
  RangeImage out = image;
  for (int v = 0; v < depth.rows(); ++v) {
    for (int u = 0; u < depth.cols(); ++u) {
      if (image.valid(v, u) && !keeper.kept()(v, u)) {
        out.invalidate(v, u, InvalidReason::jump_edge);
      }
    }
  }
  return out;
}

}  // namespace tofmap

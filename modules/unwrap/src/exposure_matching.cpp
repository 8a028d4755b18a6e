// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "exposure_matching.hpp"

#include "fast_math.hpp"
#include "surface_slopes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
using Plane = std::vector<float>;

/// B sees the surface that A sees only if its amplitude is A's times the gain and the square of the
/// ranges' ratio, to same_light_ratio and four standard deviations.
constexpr float ratio_sigmas = 4;

/// The nearest counts are looked up where each of them puts the surface in B; all farther ones
/// where the first of them does, as parallax is small there.
constexpr int counts_apart = 3;

/// Motion up to this leaves in B's pixels what it has left in A's, at the edges of surfaces, too.
constexpr double unmoved_px = 0.15;

/// Amplitudes and noise of pixels of A, and those of B that are compared with them.
struct Light {
  const float* amplitude_a;
  const float* amplitude_b;
  const float* sigma_a_cycles;
  const float* sigma_b_cycles;
};

/// Not 0 where both see the same light. `nearness` is the ratio of the range from A's place to that
/// from B's.
TOFMAP_VECTOR_CLONES void compare_light(int count, const Light& light_, const float* nearness,
                                        float gain, float* same) {
  const Light light = light_;
  constexpr float turn = 2 * std::numbers::pi_v<float>;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float expected = light.amplitude_a[i] * gain * nearness[i] * nearness[i];
    const float measured = light.amplitude_b[i];
    const float greater = expected > measured ? expected : measured;
    const float lesser = expected > measured ? measured : expected;
    const float sigma_a = light.sigma_a_cycles[i];
    const float sigma_b = light.sigma_b_cycles[i];
    const float noise = turn * std::sqrt(sigma_a * sigma_a + sigma_b * sigma_b);
    // Of a logarithm, to first order.
    const float tolerated = same_light_ratio * (1 + ratio_sigmas * noise);
    same[i] = greater <= tolerated * lesser ? 1.0F : 0.0F;
  }
}

/// Not 0 in the pixels of B beside which the surface ends: it steps or bends there, along a row or
/// along a column. `before` and `after` are the phases of the pixels on both sides.
TOFMAP_VECTOR_CLONES void mark_edges(int count, const float* phase, const float* sigma_cycles,
                                     const float* before, const float* after, float least_cycles,
                                     std::uint8_t* is_edge) {
  constexpr float sigmas = 4 * 2.45F;  // √6: the noise of a second difference
  constexpr float share_of_rise = 0.5F;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const bool is_whole = before[i] == before[i] && after[i] == after[i] && phase[i] == phase[i];
    const float rise = to_half_cycle(is_whole ? phase[i] - before[i] : 0.0F);
    const float next = to_half_cycle(is_whole ? after[i] - phase[i] : 0.0F);
    const float tolerated = sigmas * sigma_cycles[i] + least_cycles;
    const bool is_bent = is_whole && !is_straight(rise, next, tolerated, share_of_rise);
    is_edge[i] |= is_bent ? 1 : 0;
  }
}

/// Where B's surfaces end.
ImageU8 find_edges(const ExposurePair& pair, double wavelength_b_m) {
  constexpr double least_bend_m = 0.08;
  const auto least_cycles = static_cast<float>(least_bend_m / wavelength_b_m);
  const ImageF& phase = pair.phase_b;
  ImageU8 edges = ImageU8::Zero(phase.rows(), phase.cols());
  const auto cols = static_cast<int>(phase.cols());
  for (Eigen::Index v = 0; v < phase.rows(); ++v) {
    const Eigen::Index first = v * cols;
    const float* row = phase.data() + first;
    const float* sigma = pair.sigma_b_cycles.data() + first;
    std::uint8_t* out = edges.data() + first;
    if (cols > 2) mark_edges(cols - 2, row + 1, sigma + 1, row, row + 2, least_cycles, out + 1);
    if (v == 0 || v + 1 == phase.rows()) continue;
    mark_edges(cols, row, sigma, row - cols, row + cols, least_cycles, out);
  }
  return edges;
}

/// The noise of B's phase, and what the place in B is uncertain by, on the surface's slope.
class PlacedSigma {
 public:
  PlacedSigma(const ExposureStep& step, const BeatLimits& limits)
      : place_(static_cast<float>(step.place_sigma_px() / limits.wavelength_b_m)),
        rough_place_(static_cast<float>(step.rough_sigma_px() / limits.wavelength_b_m)) {}

  float cycles(float sigma_cycles, const SurfaceSlopes& slopes, std::size_t i) const {
    const float across = place_ * slopes.across_m[i];
    const float along = place_ * slopes.along_m[i];
    const float rough = rough_place_ * slopes.rough_m[i];
    return std::sqrt(sigma_cycles * sigma_cycles + across * across + along * along + rough * rough);
  }

 private:
  float place_;  ///< cycles for a slope of one metre a pixel
  float rough_place_;
};

/// u · t − q · (ω × u), equation 17 without what depends on the range; and q · t, which is divided
/// by it.
struct SmallMotion {
  float tx, ty, tz, wx, wy, wz;
};
TOFMAP_VECTOR_CLONES void add_small_motion(int count, const float* ux, const float* uy,
                                           const float* uz, const float* qx, const float* qy,
                                           const float* qz, const SmallMotion& motion,
                                           float* predicted_m, float* lateral_m2) {
  const auto [tx, ty, tz, wx, wy, wz] = motion;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float cx = wy * uz[i] - wz * uy[i];
    const float cy = wz * ux[i] - wx * uz[i];
    const float cz = wx * uy[i] - wy * ux[i];
    predicted_m[i] += ux[i] * tx + uy[i] * ty + uz[i] * tz - (qx[i] * cx + qy[i] * cy + qz[i] * cz);
    lateral_m2[i] = qx[i] * tx + qy[i] * ty + qz[i] * tz;
  }
}

/// B's phase plus what is predicted of the residual, [0, 1).
TOFMAP_VECTOR_CLONES void correct_phase(int count, const float* phase_b, const float* predicted_m,
                                        float per_wavelength, float* corrected) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float cycles = phase_b[i] + predicted_m[i] * per_wavelength;
    const float wrapped = to_half_cycle(cycles == cycles ? cycles : 0.0F);
    const float positive = wrapped < 0 ? wrapped + 1 : wrapped;
    corrected[i] = positive < 1 ? positive : 0.0F;
  }
}

/// Rows of numbers that live as long as an image is matched.
struct RowBuffers {
  explicit RowBuffers(std::size_t cols)
      : predicted_m(cols),
        lateral_m2(cols),
        error_m(cols),
        range_m(cols),
        same(cols, 1.0F),
        nearness(cols, 1.0F) {}

  Plane predicted_m, lateral_m2, error_m, range_m, same, nearness;
};

/// One row of both exposures.
struct RowPair {
  RowPair(const ExposurePair& pair, Eigen::Index row)
      : cols(static_cast<int>(pair.phase_a.cols())),
        phase_a(at(pair.phase_a, row)),
        amplitude_a(at(pair.amplitude_a, row)),
        sigma_a(at(pair.sigma_a_cycles, row)),
        phase_b(at(pair.phase_b, row)),
        amplitude_b(at(pair.amplitude_b, row)),
        sigma_b(at(pair.sigma_b_cycles, row)) {}

  static const float* at(const ImageF& image, Eigen::Index row) {
    return image.size() > 0 ? image.data() + row * image.cols() : nullptr;
  }

  int cols;
  const float* phase_a;
  const float* amplitude_a;  ///< null without amplitudes
  const float* sigma_a;
  const float* phase_b;
  const float* amplitude_b;
  const float* sigma_b;
};

/// What one group of counts makes of a row: B's pixels, looked up where the counts put the surface.
struct WarpedRow {
  explicit WarpedRow(std::size_t cols)
      : range_m(cols),
        col(cols),
        row(cols),
        shrinkage_m(cols),
        phase_b(cols),
        amplitude_b(cols),
        sigma_b(cols),
        rest_m(cols),
        predicted_m(cols),
        nearness(cols),
        same(cols, 1.0F) {}

  Plane range_m, col, row, shrinkage_m;
  Plane phase_b;  ///< NaN where B did not see it
  Plane amplitude_b, sigma_b;
  Plane rest_m;  ///< of the residual, by what is less than a pixel
  Plane predicted_m, nearness, same;
};

/// Matches an image row by row where the motion moves it by pixels.
class WarpedMatching {
 public:
  WarpedMatching(const ExposurePair& pair, const PairGeometry& geometry, const CameraErrors& camera,
                 const ExposureStep& step)
      : pair_(pair),
        geometry_(geometry),
        table_(camera),
        gain_(static_cast<float>(camera.amplitude_gain)),
        warp_(geometry.camera, step.motion),
        sigma_(step, geometry.limits),
        slopes_(pair, geometry),
        edges_(find_edges(pair, geometry.limits.wavelength_b_m)),
        warped_(static_cast<std::size_t>(pair.phase_a.cols())),
        best_cycles_(static_cast<std::size_t>(pair.phase_a.cols())),
        is_lost_(best_cycles_.size()),
        found_(best_cycles_.size()) {
    for (int n = 0; n < geometry.limits.count_a; ++n) {
      shift_cycles_.push_back(
          static_cast<float>(residual_shift_cycles(geometry.limits.wavelength_ratio(), n)));
      farthest_cycles_.push_back(farthest_phase_cycles(geometry.limits, n));
    }
  }

  void match(Eigen::Index row, MatchedExposure& out) {
    slopes_.find(row);
    std::ranges::fill(best_cycles_, 1.0F);
    std::ranges::fill(is_lost_, 0);
    const int groups = std::min(geometry_.limits.count_a, counts_apart + 1);
    for (int group = 0; group < groups; ++group) {
      look_up(row, group);
      predict(row);
      take_better(row, group, out);
    }
    give_up_lost(row, out);
  }

 private:
  void look_up(Eigen::Index row, int group) {
    const RowPair pair(pair_, row);
    const auto wavelength_m = static_cast<float>(geometry_.limits.wavelength_a_m);
    for (int i = 0; i < pair.cols; ++i) {
      warped_.range_m[static_cast<std::size_t>(i)] =
          (pair.phase_a[i] + static_cast<float>(group)) * wavelength_m;
    }
    const Eigen::Index place = row * pair_.phase_a.cols();
    warp(warp_, pair.cols, geometry_.rays.x.data() + place, geometry_.rays.y.data() + place,
         geometry_.rays.z.data() + place, warped_.range_m.data(), warped_.col.data(),
         warped_.row.data(), warped_.shrinkage_m.data());
    for (int i = 0; i < pair.cols; ++i) fetch(static_cast<std::size_t>(i), group);
  }

  /// B's pixel for one pixel of the row.
  void fetch(std::size_t i, int group) {
    const float col = warped_.col[i];
    const float row = warped_.row[i];
    warped_.phase_b[i] = nan;
    const bool is_inside = col > -0.5F && row > -0.5F &&
                           col < static_cast<float>(pair_.phase_b.cols()) - 0.5F &&
                           row < static_cast<float>(pair_.phase_b.rows()) - 0.5F;
    if (!is_inside) {
      // The nearest surface would have left the image: what B shows of farther ones is no evidence
      // against it.
      if (group == 0 && warped_.range_m[i] == warped_.range_m[i]) is_lost_[i] = 1;
      return;
    }
    const auto u = static_cast<Eigen::Index>(col + 0.5F);
    const auto v = static_cast<Eigen::Index>(row + 0.5F);
    const Eigen::Index place = v * pair_.phase_b.cols() + u;
    // A pixel less or more makes it another surface.
    if (edges_.data()[place] != 0) return;
    warped_.phase_b[i] = pair_.phase_b.data()[place];
    warped_.sigma_b[i] = pair_.sigma_b_cycles.data()[place];
    if (pair_.has_amplitude()) warped_.amplitude_b[i] = pair_.amplitude_b.data()[place];
    warped_.rest_m[i] = slopes_.across_m[i] * (col - static_cast<float>(u)) +
                        slopes_.along_m[i] * (row - static_cast<float>(v));
  }

  void predict(Eigen::Index row) {
    const RowPair pair(pair_, row);
    predict_camera_errors(table_, pair.cols, pair.phase_a, warped_.phase_b.data(), pair.amplitude_a,
                          warped_.predicted_m.data());
    for (std::size_t i = 0; i < warped_.range_m.size(); ++i) {
      warped_.predicted_m[i] += warped_.shrinkage_m[i] + warped_.rest_m[i];
      const float from_b_m = std::max(warped_.range_m[i] - warped_.shrinkage_m[i], 0.01F);
      warped_.nearness[i] = warped_.range_m[i] / from_b_m;
    }
    if (!pair_.has_amplitude()) return;
    compare_light(
        pair.cols,
        {pair.amplitude_a, warped_.amplitude_b.data(), pair.sigma_a, warped_.sigma_b.data()},
        warped_.nearness.data(), gain_, warped_.same.data());
  }

  /// The residuals of the group's counts: those that fit better than any before decide.
  void take_better(Eigen::Index row, int group, MatchedExposure& out) {
    const RowPair pair(pair_, row);
    const double ratio = geometry_.limits.wavelength_a_m / geometry_.limits.wavelength_b_m;
    const auto wavelength_b_m = static_cast<float>(geometry_.limits.wavelength_b_m);
    const int end = group == counts_apart ? geometry_.limits.count_a : group + 1;
    for (int i = 0; i < pair.cols; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const bool is_candidate = warped_.phase_b[at] == warped_.phase_b[at] &&
                                warped_.same[at] != 0 &&
                                out.sigma_b_cycles(row, i) == MatchedExposure::unseen_sigma_cycles;
      if (!is_candidate || pair.phase_a[i] != pair.phase_a[i]) continue;
      const float rest = pair.phase_a[i] * static_cast<float>(ratio) - warped_.phase_b[at] -
                         warped_.predicted_m[at] / wavelength_b_m;
      for (int n = group; n < end; ++n) {
        const auto count = static_cast<std::size_t>(n);
        if (pair.phase_a[i] > farthest_cycles_[count]) break;
        const float residual = std::abs(to_half_cycle(rest + shift_cycles_[count]));
        if (residual >= best_cycles_[at]) continue;
        best_cycles_[at] = residual;
        const float corrected = warped_.phase_b[at] + warped_.predicted_m[at] / wavelength_b_m;
        found_[at] = {corrected - std::floor(corrected), warped_.amplitude_b[at],
                      sigma_.cycles(warped_.sigma_b[at], slopes_, at)};
      }
    }
  }

  /// Writes down what was found, but for pixels whose nearest surface has left the image.
  void give_up_lost(Eigen::Index row, MatchedExposure& out) {
    for (std::size_t i = 0; i < best_cycles_.size(); ++i) {
      if (best_cycles_[i] >= 1 || is_lost_[i] != 0) continue;
      const auto u = static_cast<Eigen::Index>(i);
      out.phase_b(row, u) = found_[i].phase < 1 ? found_[i].phase : 0.0F;
      out.sigma_b_cycles(row, u) = found_[i].sigma;
      if (pair_.has_amplitude()) out.amplitude_b(row, u) = found_[i].amplitude;
    }
  }

  struct Found {
    float phase;
    float amplitude;
    float sigma;
  };

  const ExposurePair& pair_;
  const PairGeometry& geometry_;
  CameraErrorTable table_;
  float gain_;
  ExposureWarp warp_;
  PlacedSigma sigma_;
  SurfaceSlopes slopes_;
  ImageU8 edges_;
  WarpedRow warped_;
  Plane best_cycles_;
  std::vector<char> is_lost_;
  std::vector<Found> found_;
  Plane shift_cycles_;     ///< what each count adds to the residual
  Plane farthest_cycles_;  ///< phase up to which each count is within the limits
};

}  // namespace

double ExposureStep::rough_sigma_px() const {
  // Half a pixel at most, all of it alike.
  return std::min(0.3, flow_px);
}

double ExposureStep::place_sigma_px() const {
  // Motion is known to a tenth; surfaces are straight to a tenth of a pixel.
  constexpr double share = 0.1;
  return share * std::min(1.0, flow_px);
}

MatchedExposure unmatched(const ExposurePair& pair) {
  const auto is_missing = pair.phase_a.isNaN();
  const ImageF known = pair.phase_b.isNaN().select(0.0F, pair.phase_b);
  const Eigen::Index rows = pair.phase_a.rows();
  const Eigen::Index cols = pair.phase_a.cols();
  MatchedExposure out{is_missing.select(ImageF::Constant(rows, cols, nan), known),
                      {},
                      ImageF::Constant(rows, cols, MatchedExposure::unseen_sigma_cycles)};
  constexpr float dark = 1e-6F;
  if (pair.has_amplitude()) out.amplitude_b.setConstant(rows, cols, dark);
  return out;
}

void match_exposure(const ExposurePair& pair, const PairGeometry& geometry,
                    const CameraErrors& camera, const ExposureStep& step, MatchedExposure& out) {
  WarpedMatching matching(pair, geometry, camera, step);
  for (Eigen::Index row = 0; row < pair.phase_a.rows(); ++row) matching.match(row, out);
}

void match_still_exposure(const ExposurePair& pair, const PairGeometry& geometry,
                          const CameraErrors& camera, const ExposureStep& step,
                          MatchedExposure& out) {
  const auto cols = static_cast<std::size_t>(pair.phase_a.cols());
  const CameraErrorTable table(camera);
  const auto per_wavelength = static_cast<float>(1 / geometry.limits.wavelength_b_m);
  const Eigen::Vector3f t = step.motion.translation_m.cast<float>();
  const Eigen::Vector3f w = step.motion.rotation_rad.cast<float>();
  const SmallMotion small{t.x(), t.y(), t.z(), w.x(), w.y(), w.z()};
  const PlacedSigma sigma(step, geometry.limits);
  const bool may_miss = geometry.knows_camera() && step.flow_px > unmoved_px;
  const ImageU8 edges = may_miss ? find_edges(pair, geometry.limits.wavelength_b_m) : ImageU8();
  // How far away a surface is matters little beyond the fourth wavelength.
  BeatLimits near_counts = geometry.limits;
  near_counts.count_a = std::min(near_counts.count_a, 4);
  SurfaceSlopes slopes(pair, geometry);
  RowBuffers of(cols);
  for (Eigen::Index row = 0; row < pair.phase_a.rows(); ++row) {
    const RowPair in(pair, row);
    predict_camera_errors(table, in.cols, in.phase_a, in.phase_b, in.amplitude_a,
                          of.predicted_m.data());
    if (geometry.knows_camera()) {
      slopes.find(row);
      const Eigen::Index place = row * pair.phase_a.cols();
      add_small_motion(in.cols, geometry.rays.x.data() + place, geometry.rays.y.data() + place,
                       geometry.rays.z.data() + place, slopes.gradient_x.data(),
                       slopes.gradient_y.data(), slopes.gradient_z.data(), small,
                       of.predicted_m.data(), of.lateral_m2.data());
      find_nearest(near_counts, in.cols, in.phase_a, in.phase_b, of.predicted_m.data(),
                   of.error_m.data(), of.range_m.data());
      for (std::size_t i = 0; i < cols; ++i) {
        of.predicted_m[i] -= of.lateral_m2[i] / std::max(of.range_m[i], 0.1F);
      }
    }
    if (in.amplitude_a != nullptr) {
      compare_light(in.cols, {in.amplitude_a, in.amplitude_b, in.sigma_a, in.sigma_b},
                    of.nearness.data(), static_cast<float>(camera.amplitude_gain), of.same.data());
    }
    float* corrected = out.phase_b.data() + row * pair.phase_a.cols();
    correct_phase(in.cols, in.phase_b, of.predicted_m.data(), per_wavelength, corrected);
    for (std::size_t i = 0; i < cols; ++i) {
      const auto u = static_cast<Eigen::Index>(i);
      const bool is_present = in.phase_a[i] == in.phase_a[i] && in.phase_b[i] == in.phase_b[i];
      if (!is_present) {
        corrected[i] = in.phase_a[i] == in.phase_a[i] ? 0.0F : nan;
        continue;
      }
      if (of.same[i] == 0 || (may_miss && edges(row, u) != 0)) continue;
      out.sigma_b_cycles(row, u) = sigma.cycles(in.sigma_b[i], slopes, i);
      if (in.amplitude_b != nullptr) out.amplitude_b(row, u) = in.amplitude_b[i];
    }
  }
}

}  // namespace tofmap

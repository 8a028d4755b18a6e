// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/exposure_matching.hpp"

#include "errors/matching_loops.hpp"
#include "errors/surface_slopes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tofmap {
namespace {

using matching::BPixels;
using matching::MutableBPixels;

/// One number for each pixel of a row.
using Row = std::vector<float>;

/// If the image moves by less than this, A and B see the same surface in a pixel, even at edges.
constexpr double unmoved_px = 0.15;

/// B's phases, with NaN beside the edges of surfaces, where an error of one pixel may lead to
/// another surface.
ImageF phase_within_surfaces(const ExposurePair& pair, double wavelength_b_m) {
  constexpr double least_bend_m = 0.08;
  const auto least_cycles = static_cast<float>(least_bend_m / wavelength_b_m);
  const ImageF& phase = pair.phase_b;
  ImageF kept = phase;
  const auto cols = static_cast<int>(phase.cols());
  for (Eigen::Index v = 0; v < phase.rows(); ++v) {
    const float* row = phase.data() + v * cols;
    const float* sigma = pair.sigma_b_cycles.data() + v * cols;
    float* out = kept.data() + v * cols;
    if (cols > 2) {
      matching::drop_at_ends(cols - 2, row + 1, sigma + 1, row, row + 2, least_cycles, out + 1);
    }
    if (v == 0 || v + 1 == phase.rows()) continue;
    matching::drop_at_ends(cols, row, sigma, row - cols, row + cols, least_cycles, out);
  }
  return kept;
}

/// Pointers to the same row of all images of both exposures.
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

/// Buffers for a row of B. If there are no amplitudes, they stay 1.
struct RowOfB {
  explicit RowOfB(std::size_t cols) : phase(cols, nan), amplitude(cols, 1.0F), sigma(cols) {}

  BPixels read() const { return {phase.data(), amplitude.data(), sigma.data()}; }
  MutableBPixels write() { return {phase.data(), amplitude.data(), sigma.data()}; }

  Row phase, amplitude, sigma;
};

/// Base of the two classes that match images row by row.
class Matching {
 public:
  Matching(const ExposurePair& pair, const PairGeometry& geometry, const CameraErrors& camera,
           const ExposureStep& step)
      : pair_(pair),
        geometry_(geometry),
        step_(step),
        camera_(camera),
        gain_(static_cast<float>(camera.amplitude_gain)),
        per_wavelength_(static_cast<float>(1 / geometry.limits.wavelength_b_m)),
        slopes_(pair, geometry),
        same_(cols(), 1.0F),
        nearness_(cols(), 1.0F),
        predicted_m_(cols()),
        range_m_(cols()),
        no_amplitude_(cols()) {}

 protected:
  std::size_t cols() const { return static_cast<std::size_t>(pair_.phase_a.cols()); }

  matching::Slopes slopes() const {
    return {slopes_.across_m.data(), slopes_.along_m.data(), slopes_.rough_m.data()};
  }

  /// Flags the pixels in which the amplitudes of both exposures agree.
  void compare_light(const RowPair& pair, const BPixels& b) {
    if (!pair_.has_amplitude()) return;
    matching::compare_light(pair.cols,
                            {pair.amplitude_a, b.amplitude, pair.sigma_a, b.sigma_cycles},
                            nearness_.data(), gain_, same_.data());
  }

  /// Adds the uncertainty of positions in B to the noise of B's phases.
  void add_place_noise(float* sigma_cycles) const {
    const auto per_m = [&](double sigma_px) {
      return static_cast<float>(sigma_px) * per_wavelength_;
    };
    matching::add_place_noise(static_cast<int>(cols()), slopes(), per_m(step_.place_sigma_px()),
                              per_m(step_.rough_sigma_px()), sigma_cycles);
  }

  MutableBPixels row_of(MatchedExposure& out, Eigen::Index row) {
    const Eigen::Index first = row * pair_.phase_a.cols();
    return {out.phase_b.data() + first,
            pair_.has_amplitude() ? out.amplitude_b.data() + first : no_amplitude_.data(),
            out.sigma_b_cycles.data() + first};
  }

  const ExposurePair& pair_;
  const PairGeometry& geometry_;
  const ExposureStep& step_;
  const CameraErrors& camera_;
  float gain_;
  float per_wavelength_;
  SurfaceSlopes slopes_;
  Row same_;         ///< flags of pixels whose amplitudes agree
  Row nearness_;     ///< range from A divided by range from B
  Row predicted_m_;  ///< predicted residual
  Row range_m_;

 private:
  Row no_amplitude_;  ///< receives amplitudes if the pair has none
};

/// Matches an image row by row if the motion leaves every surface in its pixel.
class StillMatching : Matching {
 public:
  StillMatching(const ExposurePair& pair, const PairGeometry& geometry, const CameraErrors& camera,
                const ExposureStep& step)
      : Matching(pair, geometry, camera, step),
        near_limits_(geometry.limits),
        lateral_m2_(cols()),
        unused_(cols()),
        corrected_(cols()) {
    // Beyond the fourth wavelength, the range has little influence on the predicted residual.
    near_limits_.count_a = std::min(near_limits_.count_a, 4);
    const bool may_miss = geometry.knows_camera() && step.flow_px > unmoved_px;
    if (may_miss) kept_phase_b_ = phase_within_surfaces(pair, geometry.limits.wavelength_b_m);
  }

  void match(Eigen::Index row, MatchedExposure& out) {
    const RowPair in(pair_, row);
    slopes_.find(row);
    predict_camera_errors(camera_, in.cols, in.phase_a, in.phase_b, in.amplitude_a,
                          predicted_m_.data());
    if (geometry_.knows_camera()) add_motion(row);
    if (!pair_.has_amplitude()) std::ranges::fill(same_, 1.0F);
    compare_light(in, {in.phase_b, in.amplitude_b, in.sigma_b});
    const float* kept = kept_phase_b_.size() > 0 ? RowPair::at(kept_phase_b_, row) : in.phase_b;
    matching::clear_missing(in.cols, in.phase_a, kept, same_.data());
    matching::correct_phase(in.cols, in.phase_b, predicted_m_.data(), per_wavelength_,
                            corrected_.phase.data());
    std::copy_n(in.sigma_b, in.cols, corrected_.sigma.data());
    add_place_noise(corrected_.sigma.data());
    const BPixels found{corrected_.phase.data(),
                        pair_.has_amplitude() ? in.amplitude_b : corrected_.amplitude.data(),
                        corrected_.sigma.data()};
    const MutableBPixels to = row_of(out, row);
    matching::store(in.cols, same_.data(), found, to);
    matching::store_phases(in.cols, in.phase_a, in.phase_b, found.phase, to.phase);
  }

 private:
  /// Adds the effect of the motion to the predicted residual.
  void add_motion(Eigen::Index row) {
    const RowPair in(pair_, row);
    slopes_.find_gradients(row);
    const matching::RaysAndGradients of{
        {RowPair::at(geometry_.rays.x, row), RowPair::at(geometry_.rays.y, row),
         RowPair::at(geometry_.rays.z, row)},
        {slopes_.gradient_x.data(), slopes_.gradient_y.data(), slopes_.gradient_z.data()}};
    matching::add_small_motion(in.cols, of, step_.motion.translation_m.cast<float>(),
                               step_.motion.rotation_rad.cast<float>(), predicted_m_.data(),
                               lateral_m2_.data());
    find_nearest(near_limits_, in.cols, in.phase_a, in.phase_b, predicted_m_.data(), unused_.data(),
                 range_m_.data());
    matching::subtract_lateral(in.cols, lateral_m2_.data(), range_m_.data(), predicted_m_.data());
  }

  PairLimits near_limits_;
  ImageF kept_phase_b_;  ///< B's phases without those beside edges; empty if all are kept
  Row lateral_m2_;
  Row unused_;
  RowOfB corrected_;
};

/// Matches an image row by row if the motion shifts it by pixels.
class WarpedMatching : Matching {
 public:
  WarpedMatching(const ExposurePair& pair, const PairGeometry& geometry, const CameraErrors& camera,
                 const ExposureStep& step)
      : Matching(pair, geometry, camera, step),
        warp_(geometry.camera, step.motion),
        counts_apart_(counts_apart(geometry, step.motion)),
        kept_phase_b_(phase_within_surfaces(pair, geometry.limits.wavelength_b_m)),
        of_a_m_(cols()),
        col_px_(cols()),
        row_px_(cols()),
        shrinkage_m_(cols()),
        index_(cols()),
        off_across_px_(cols()),
        off_along_px_(cols()),
        inside_(cols()),
        stays_(cols()),
        residual_cycles_(cols()),
        limited_phase_(cols()),
        least_cycles_(cols()),
        best_cycles_(cols()),
        seen_(cols()),
        found_(cols()) {}

  void match(Eigen::Index row, MatchedExposure& out) {
    const RowPair in(pair_, row);
    slopes_.find(row);
    predict_errors_of_a(camera_, in.cols, in.phase_a, in.amplitude_a, of_a_m_.data());
    std::ranges::fill(best_cycles_, 1.0F);
    const int groups = std::min(geometry_.limits.count_a, counts_apart_ + 1);
    for (int group = 0; group < groups; ++group) {
      look_up(row, group);
      // If the surface at wrap count 0 has left B's image, farther surfaces that B does see are no
      // evidence against it, so the pixel stays unseen.
      if (group == 0) stays_ = inside_;
      take_better(row, group, group + 1 == groups ? geometry_.limits.count_a : group + 1);
    }
    write_down(row, out);
  }

 private:
  /// Number of wrap counts that are looked up at separate positions in B. All larger wrap counts
  /// are looked up together, at the position of the smallest of them, since parallax is small
  /// there: at most a third of a pixel, unless the camera has moved so far that the limit of 3
  /// applies.
  static int counts_apart(const PairGeometry& geometry, const ExposureMotion& motion) {
    constexpr double small_px = 1.0 / 3;
    constexpr double most = 3;
    const double focal_px = std::max(geometry.camera.fx_px, geometry.camera.fy_px);
    const double parallax_px =
        focal_px * motion.translation_m.norm() / geometry.limits.wavelength_a_m;
    return static_cast<int>(std::clamp(std::ceil(parallax_px / small_px), 1.0, most));
  }

  matching::ImagePlaces places() {
    return {index_.data(), off_across_px_.data(), off_along_px_.data(), inside_.data()};
  }

  /// Reads B's pixels at the positions at which wrap count `group` puts the surfaces of a row.
  void look_up(Eigen::Index row, int group) {
    const RowPair in(pair_, row);
    matching::fill_ranges(in.cols, in.phase_a, static_cast<float>(group),
                          static_cast<float>(geometry_.limits.wavelength_a_m), range_m_.data());
    warp(warp_, in.cols, RowPair::at(geometry_.rays.x, row), RowPair::at(geometry_.rays.y, row),
         RowPair::at(geometry_.rays.z, row), range_m_.data(), col_px_.data(), row_px_.data(),
         shrinkage_m_.data());
    matching::find_places(in.cols, col_px_.data(), row_px_.data(), kept_phase_b_.rows(),
                          kept_phase_b_.cols(), places());
    const auto gather = [&](const ImageF& image, Row& values) {
      matching::gather(in.cols, image.data(), index_.data(), values.data());
    };
    gather(kept_phase_b_, seen_.phase);
    gather(pair_.sigma_b_cycles, seen_.sigma);
    if (pair_.has_amplitude()) gather(pair_.amplitude_b, seen_.amplitude);
    matching::drop_outside(in.cols, inside_.data(), seen_.phase.data());
  }

  /// Keeps the pixels that fit better at one of the wrap counts `first` … `end` − 1 than at all
  /// smaller ones.
  void take_better(Eigen::Index row, int first, int end) {
    const RowPair in(pair_, row);
    predicted_m_ = of_a_m_;
    add_errors_of_b(camera_, in.cols, seen_.phase.data(), predicted_m_.data());
    matching::add_place(in.cols, slopes(), places(), range_m_.data(), shrinkage_m_.data(),
                        predicted_m_.data(), nearness_.data());
    compare_light(in, seen_.read());
    std::ranges::fill(least_cycles_, 2.0F);
    const double ratio = geometry_.limits.wavelength_ratio();
    matching::find_residuals(in.cols,
                             {in.phase_a, seen_.phase.data(), predicted_m_.data(),
                              static_cast<float>(ratio), per_wavelength_},
                             residual_cycles_.data(), limited_phase_.data());
    for (int n = first; n < end; ++n) {
      matching::keep_least(in.cols, residual_cycles_.data(), limited_phase_.data(),
                           static_cast<float>(residual_shift_cycles(ratio, n)),
                           farthest_phase_cycles(geometry_.limits, n), least_cycles_.data());
    }
    matching::correct_phase(in.cols, seen_.phase.data(), predicted_m_.data(), per_wavelength_,
                            seen_.phase.data());
    matching::take_better(in.cols, least_cycles_.data(), same_.data(), seen_.read(),
                          best_cycles_.data(), found_.write());
  }

  /// Writes the pixels that were found now and were unseen before.
  void write_down(Eigen::Index row, MatchedExposure& out) {
    add_place_noise(found_.sigma.data());
    const MutableBPixels to = row_of(out, row);
    matching::keep_new(static_cast<int>(cols()), best_cycles_.data(), to.sigma_cycles,
                       stays_.data());
    matching::store(static_cast<int>(cols()), stays_.data(), found_.read(), to);
  }

  ExposureWarp warp_;
  int counts_apart_;
  ImageF kept_phase_b_;
  Row of_a_m_;  ///< terms of the predicted residual that do not depend on B's phase
  Row col_px_, row_px_, shrinkage_m_;
  std::vector<std::int32_t> index_;
  Row off_across_px_, off_along_px_, inside_;
  Row stays_;  ///< flags of pixels whose surface at wrap count 0 lies inside B's image
  Row residual_cycles_, limited_phase_, least_cycles_, best_cycles_;
  RowOfB seen_;   ///< pixels at the positions of the current wrap counts
  RowOfB found_;  ///< pixels at the positions of the best wrap counts so far
};

template <class RowMatching>
void match_rows(RowMatching matching, Eigen::Index rows, MatchedExposure& out) {
  for (Eigen::Index row = 0; row < rows; ++row) matching.match(row, out);
}

}  // namespace

double ExposureStep::rough_sigma_px() const {
  // Rounding to whole pixels is a uniform error of up to half a pixel: its sigma is 0.3 pixels.
  return std::min(0.3, flow_px);
}

double ExposureStep::place_sigma_px() const {
  // The motion is known to 10 %, and surfaces are straight to a tenth of a pixel.
  constexpr double share = 0.1;
  return share * std::min(1.0, flow_px);
}

MatchedExposure unmatched(const ExposurePair& pair) {
  constexpr float dark = 1e-6F;
  const Eigen::Index rows = pair.phase_a.rows();
  const Eigen::Index cols = pair.phase_a.cols();
  MatchedExposure out{
      ImageF(rows, cols), {}, ImageF::Constant(rows, cols, MatchedExposure::unseen_sigma_cycles)};
  matching::start_unseen(static_cast<int>(pair.phase_a.size()), pair.phase_a.data(),
                         pair.phase_b.data(), out.phase_b.data());
  if (pair.has_amplitude()) out.amplitude_b.setConstant(rows, cols, dark);
  return out;
}

void match_exposure(const ExposurePair& pair, const PairGeometry& geometry,
                    const CameraErrors& camera, const ExposureStep& step, MatchedExposure& out) {
  match_rows(WarpedMatching(pair, geometry, camera, step), pair.phase_a.rows(), out);
}

void match_still_exposure(const ExposurePair& pair, const PairGeometry& geometry,
                          const CameraErrors& camera, const ExposureStep& step,
                          MatchedExposure& out) {
  match_rows(StillMatching(pair, geometry, camera, step), pair.phase_a.rows(), out);
}

}  // namespace tofmap

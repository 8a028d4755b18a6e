// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tofmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// exp(−(difference − i)² / 2σ²) for the three configurations, with σ² of every node; NaN
/// differences stay NaN.
std::array<ImageF, 3> gaussian_of_configurations(const ImageF& difference, const ImageF& variance) {
  std::array<ImageF, 3> term;
  for (int i = -1; i <= 1; ++i) {
    term[static_cast<std::size_t>(i + 1)] =
        (-0.5F * (difference - static_cast<float>(i)).square() / variance).exp();
  }
  return term;
}

/// Two values of neighbours, summed at the node between them.
ImageF neighbour_sum_x(const ImageF& image) {
  const Eigen::Index nodes = std::max<Eigen::Index>(image.cols() - 1, 0);
  return image.rightCols(nodes) + image.leftCols(nodes);
}

ImageF neighbour_sum_y(const ImageF& image) {
  const Eigen::Index nodes = std::max<Eigen::Index>(image.rows() - 1, 0);
  return image.bottomRows(nodes) + image.topRows(nodes);
}

ImageF forward_difference_x(const ImageF& image) {
  const Eigen::Index nodes = std::max<Eigen::Index>(image.cols() - 1, 0);
  return image.rightCols(nodes) - image.leftCols(nodes);
}

ImageF forward_difference_y(const ImageF& image) {
  const Eigen::Index nodes = std::max<Eigen::Index>(image.rows() - 1, 0);
  return image.bottomRows(nodes) - image.topRows(nodes);
}

/// The median of pixels first … last (both included) of a line; sorts them into `window`.
float window_median(const float* line, Eigen::Index stride, Eigen::Index first, Eigen::Index last,
                    std::vector<float>& window) {
  window.clear();
  for (Eigen::Index t = first; t <= last; ++t) {
    const float value = line[t * stride];
    if (std::isnan(value)) continue;
    window.insert(std::upper_bound(window.begin(), window.end(), value), value);
  }
  return window.empty() ? nan : window[(window.size() - 1) / 2];
}

/// Medians of all windows of `size` pixels of one line, numbered by where they end; ends past
/// the line give the windows that its end cuts short.
void line_medians(const float* line, Eigen::Index stride, Eigen::Index length, int size,
                  std::vector<float>& medians, std::vector<float>& window) {
  medians.clear();
  for (Eigen::Index end = 0; end < length + size - 1; ++end) {
    const Eigen::Index first = std::max<Eigen::Index>(end - size + 1, 0);
    medians.push_back(window_median(line, stride, first, std::min(end, length - 1), window));
  }
}

/// Neg and pos of the node between t and t + 1 are the windows that end at t and at t + k.
SideMedians side_medians(const ImageF& image, int window_px, bool along_x) {
  const Eigen::Index length = along_x ? image.cols() : image.rows();
  const Eigen::Index lines = along_x ? image.rows() : image.cols();
  const Eigen::Index stride = along_x ? 1 : image.cols();
  const Eigen::Index nodes = std::max<Eigen::Index>(length - 1, 0);
  const Eigen::Index rows = along_x ? lines : nodes;
  const Eigen::Index cols = along_x ? nodes : lines;
  SideMedians out{ImageF(rows, cols), ImageF(rows, cols)};
  std::vector<float> medians;
  std::vector<float> window;
  for (Eigen::Index s = 0; s < lines; ++s) {
    line_medians(image.data() + (along_x ? s * image.cols() : s), stride, length, window_px,
                 medians, window);
    for (Eigen::Index t = 0; t < nodes; ++t) {
      const Eigen::Index v = along_x ? s : t;
      const Eigen::Index u = along_x ? t : s;
      out.neg(v, u) = medians[static_cast<std::size_t>(t)];
      out.pos(v, u) = medians[static_cast<std::size_t>(t + window_px)];
    }
  }
  return out;
}

/// |m_R̂^neg − m_A^neg| − |m_R̂^pos − m_A^pos|, within what a configuration can say.
ImageF wrap_difference(const SideMedians& r, const SideMedians& a) {
  return ((r.neg - a.neg).abs() - (r.pos - a.pos).abs()).max(-1.0F).min(1.0F);
}

/// NaN where the phases at the node's ends are, whatever their neighbourhoods say.
ImageF where_present(const ImageF& values, const ImageF& difference) {
  return difference.isNaN().select(nan, values);
}

std::array<ImageF, 3> fuse_planes(const std::array<ImageF, 3>& f_d,
                                  const std::array<ImageF, 3>& f_f, float c_d, float c_f) {
  constexpr float least = 1e-6F;
  std::array<ImageF, 3> fused;
  for (std::size_t c = 0; c < 3; ++c) {
    fused[c] = (((1 - c_d) + c_d * f_d[c]) * ((1 - c_f) + c_f * f_f[c])).max(least);
  }
  const ImageF sum = fused[0] + fused[1] + fused[2];
  for (ImageF& plane : fused) plane = f_d[0].isNaN().select(nan, plane / sum);
  return fused;
}

}  // namespace

JumpProbabilities discontinuity_term(const ImageF& phase, const ImageF& noise_cycles,
                                     double sigma_cycles) {
  const auto slope_variance = static_cast<float>(sigma_cycles * sigma_cycles);
  const ImageF noise_variance = noise_cycles.square();
  return {gaussian_of_configurations(forward_difference_x(phase),
                                     neighbour_sum_x(noise_variance) + slope_variance),
          gaussian_of_configurations(forward_difference_y(phase),
                                     neighbour_sum_y(noise_variance) + slope_variance)};
}

SideMedians side_medians_x(const ImageF& image, int window_px) {
  return side_medians(image, window_px, true);
}

SideMedians side_medians_y(const ImageF& image, int window_px) {
  return side_medians(image, window_px, false);
}

JumpProbabilities frequency_term(const ImageF& phase, const ImageF& reconstruction_cycles,
                                 int window_px, double sigma_cycles) {
  const ImageF x = wrap_difference(side_medians_x(reconstruction_cycles, window_px),
                                   side_medians_x(phase, window_px));
  const ImageF y = wrap_difference(side_medians_y(reconstruction_cycles, window_px),
                                   side_medians_y(phase, window_px));
  const auto variance = [&](const ImageF& nodes) -> ImageF {
    return ImageF::Constant(nodes.rows(), nodes.cols(),
                            static_cast<float>(sigma_cycles * sigma_cycles));
  };
  return {gaussian_of_configurations(where_present(x, forward_difference_x(phase)), variance(x)),
          gaussian_of_configurations(where_present(y, forward_difference_y(phase)), variance(y))};
}

JumpProbabilities fuse(const JumpProbabilities& f_d, const JumpProbabilities& f_f, double c_d,
                       double c_f) {
  const auto d = static_cast<float>(c_d);
  const auto f = static_cast<float>(c_f);
  return {fuse_planes(f_d.x, f_f.x, d, f), fuse_planes(f_d.y, f_f.y, d, f)};
}

}  // namespace tofmap

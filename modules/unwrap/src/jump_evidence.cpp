// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump_evidence.hpp"

#include "fast_math.hpp"
#include "vector_clones.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tofmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// The planes of three configurations from some node on.
template <class T>
struct Configurations {
  T* minus;
  T* none;
  T* plus;
};

Configurations<float> at(std::array<ImageF, 3>& planes, Eigen::Index row) {
  const Eigen::Index place = row * planes[0].cols();
  return {planes[0].data() + place, planes[1].data() + place, planes[2].data() + place};
}

Configurations<const float> at(const std::array<ImageF, 3>& planes, Eigen::Index row) {
  const Eigen::Index place = row * planes[0].cols();
  return {planes[0].data() + place, planes[1].data() + place, planes[2].data() + place};
}

/// Nodes of an image of pixels, without values.
JumpProbabilities jump_nodes(Eigen::Index rows, Eigen::Index cols) {
  JumpProbabilities nodes;
  for (ImageF& plane : nodes.x) plane.resize(rows, std::max<Eigen::Index>(cols - 1, 0));
  for (ImageF& plane : nodes.y) plane.resize(std::max<Eigen::Index>(rows - 1, 0), cols);
  return nodes;
}

/// exp(−(difference − i)² / 2σ²) for the three configurations. `absent` is NaN for absent nodes and
/// 0 for others: a sum, unlike a choice, leaves the compiler no branch.
[[gnu::always_inline]] inline void set_gaussians(float difference, float half_precision,
                                                 float absent, const Configurations<float>& out,
                                                 int i) {
  const auto gaussian = [&](float off) {
    return exp_of_negative(-off * off * half_precision) + absent;
  };
  out.minus[i] = gaussian(difference + 1);
  out.none[i] = gaussian(difference);
  out.plus[i] = gaussian(difference - 1);
}

/// Equation 1 for nodes between pixels p and q, both in arrays of phases and of their noise.
TOFMAP_VECTOR_CLONES void fill_discontinuity(int nodes, const float* phase_p, const float* phase_q,
                                             const float* noise_p, const float* noise_q,
                                             float slope_variance,
                                             const Configurations<float>& out_) {
  const Configurations<float> out = out_;
#pragma GCC ivdep
  for (int i = 0; i < nodes; ++i) {
    const float difference = phase_q[i] - phase_p[i];
    const float variance = noise_p[i] * noise_p[i] + noise_q[i] * noise_q[i] + slope_variance;
    set_gaussians(difference, 0.5F / variance, 0 * difference, out, i);
  }
}

/// Medians before and after nodes, of the reconstruction and of the wrapped phase.
struct NodeMedians {
  const float* r_neg;
  const float* a_neg;
  const float* r_pos;
  const float* a_pos;
};

/// Equation 3 for nodes between pixels of these phases.
TOFMAP_VECTOR_CLONES void fill_frequency(int nodes, const float* phase_p, const float* phase_q,
                                         const NodeMedians& medians_, float half_precision,
                                         const Configurations<float>& out_) {
  const NodeMedians m = medians_;
  const Configurations<float> out = out_;
#pragma GCC ivdep
  for (int i = 0; i < nodes; ++i) {
    const float wraps = std::abs(m.r_neg[i] - m.a_neg[i]) - std::abs(m.r_pos[i] - m.a_pos[i]);
    // Within what a configuration can say.
    const float above = wraps > -1 ? wraps : -1.0F;
    const float difference = above < 1 ? above : 1.0F;
    set_gaussians(difference, half_precision, 0 * (phase_q[i] - phase_p[i]), out, i);
  }
}

struct Trust {
  float discontinuity;
  float frequency;
};

/// Equation 4.
TOFMAP_VECTOR_CLONES void fill_fused(int nodes, const Configurations<const float>& f_d_,
                                     const Configurations<const float>& f_f_, const Trust& trust_,
                                     const Configurations<float>& out_) {
  const Configurations<const float> f_d = f_d_;
  const Configurations<const float> f_f = f_f_;
  const Trust trust = trust_;
  const Configurations<float> out = out_;
#pragma GCC ivdep
  for (int i = 0; i < nodes; ++i) {
    const auto product = [&](float d, float f) {
      constexpr float least = 1e-6F;
      const float both = (1 - trust.discontinuity + trust.discontinuity * d) *
                         (1 - trust.frequency + trust.frequency * f);
      return both > least ? both : least;
    };
    const float minus = product(f_d.minus[i], f_f.minus[i]);
    const float none = product(f_d.none[i], f_f.none[i]);
    const float plus = product(f_d.plus[i], f_f.plus[i]);
    const float sum =
        f_d.none[i] == f_d.none[i] && f_f.none[i] == f_f.none[i] ? minus + none + plus : nan;
    const float scale = 1 / sum;
    out.minus[i] = minus * scale;
    out.none[i] = none * scale;
    out.plus[i] = plus * scale;
  }
}

/// Windows treated at a time, one in each lane.
constexpr int median_lanes = 64;

/// Medians of windows whose k-th pixels are in pixels[k], for up to median_lanes windows. `window`
/// has room for a line of lanes a pixel.
TOFMAP_VECTOR_CLONES void window_medians(int windows, const std::vector<const float*>& pixels,
                                         float* window, float* medians) {
  constexpr float missing = std::numeric_limits<float>::infinity();
  const auto size = static_cast<int>(pixels.size());
  std::array<int, median_lanes> present{};
  for (int k = 0; k < size; ++k) {
    const float* from = pixels[static_cast<std::size_t>(k)];
    float* to = window + k * median_lanes;
#pragma GCC ivdep
    for (int i = 0; i < windows; ++i) {
      const bool is_present = from[i] == from[i];
      to[i] = is_present ? from[i] : missing;
      present[static_cast<std::size_t>(i)] += is_present ? 1 : 0;
    }
  }
  // Odd and even neighbours change places in turn until all lanes are sorted.
  for (int round = 0; round < size; ++round) {
    for (int k = round % 2; k + 1 < size; k += 2) {
      float* lower = window + k * median_lanes;
      float* upper = lower + median_lanes;
#pragma GCC ivdep
      for (int i = 0; i < median_lanes; ++i) {
        const float least = lower[i] < upper[i] ? lower[i] : upper[i];
        const float greatest = lower[i] < upper[i] ? upper[i] : lower[i];
        lower[i] = least;
        upper[i] = greatest;
      }
    }
  }
  std::array<float, median_lanes> middle{};
  middle.fill(nan);
  for (int k = 0; k < size; ++k) {
    const float* value = window + k * median_lanes;
    for (int i = 0; i < median_lanes; ++i) {
      const auto lane = static_cast<std::size_t>(i);
      middle[lane] = present[lane] > 0 && (present[lane] - 1) / 2 == k ? value[i] : middle[lane];
    }
  }
  std::copy_n(middle.begin(), windows, medians);
}

/// Medians of windows, as many as wanted. `pixels` is moved along.
void line_medians(Eigen::Index windows, std::vector<const float*>& pixels,
                  std::vector<float>& window, float* medians) {
  window.resize(pixels.size() * median_lanes);
  for (Eigen::Index done = 0; done < windows; done += median_lanes) {
    const auto count = static_cast<int>(std::min<Eigen::Index>(windows - done, median_lanes));
    window_medians(count, pixels, window.data(), medians + done);
    for (const float*& pixel : pixels) pixel += count;
  }
}

}  // namespace

SideMedians side_medians_x(const ImageF& image, int window_px) {
  const Eigen::Index cols = image.cols();
  const Eigen::Index nodes = std::max<Eigen::Index>(cols - 1, 0);
  SideMedians out{ImageF(image.rows(), nodes), ImageF(image.rows(), nodes)};
  // Windows are numbered by where they end: those of the node after pixel t end at t and t + k.
  const Eigen::Index windows = cols + window_px - 1;
  std::vector<float> line(static_cast<std::size_t>(windows + window_px - 1), nan);
  std::vector<float> medians(static_cast<std::size_t>(windows));
  std::vector<const float*> pixels(static_cast<std::size_t>(window_px));
  std::vector<float> window;
  for (Eigen::Index v = 0; v < image.rows(); ++v) {
    std::copy_n(image.data() + v * cols, cols, line.begin() + window_px - 1);
    for (std::size_t k = 0; k < pixels.size(); ++k) pixels[k] = line.data() + k;
    line_medians(windows, pixels, window, medians.data());
    std::copy_n(medians.begin(), nodes, out.neg.data() + v * nodes);
    std::copy_n(medians.begin() + window_px, nodes, out.pos.data() + v * nodes);
  }
  return out;
}

SideMedians side_medians_y(const ImageF& image, int window_px) {
  const Eigen::Index cols = image.cols();
  const Eigen::Index nodes = std::max<Eigen::Index>(image.rows() - 1, 0);
  SideMedians out{ImageF(nodes, cols), ImageF(nodes, cols)};
  const std::vector<float> no_row(static_cast<std::size_t>(cols), nan);
  std::vector<const float*> pixels(static_cast<std::size_t>(window_px));
  std::vector<float> window;
  for (Eigen::Index end = 0; end < image.rows() + window_px - 1; ++end) {
    const bool is_before = end < nodes;
    const bool is_after = end >= window_px;
    if (!is_before && !is_after) continue;
    for (Eigen::Index k = 0; k < window_px; ++k) {
      const Eigen::Index v = end - k;
      pixels[static_cast<std::size_t>(k)] =
          v >= 0 && v < image.rows() ? image.data() + v * cols : no_row.data();
    }
    float* medians =
        is_before ? out.neg.data() + end * cols : out.pos.data() + (end - window_px) * cols;
    line_medians(cols, pixels, window, medians);
    if (is_before && is_after) {
      std::copy_n(medians, cols, out.pos.data() + (end - window_px) * cols);
    }
  }
  return out;
}

JumpProbabilities discontinuity_term(const ImageF& phase, const ImageF& noise_cycles,
                                     double sigma_cycles) {
  const auto variance = static_cast<float>(sigma_cycles * sigma_cycles);
  JumpProbabilities out = jump_nodes(phase.rows(), phase.cols());
  const auto fill = [&](Eigen::Index q_from_p, std::array<ImageF, 3>& planes) {
    for (Eigen::Index v = 0; v < planes[0].rows(); ++v) {
      const float* p = phase.data() + v * phase.cols();
      const float* noise = noise_cycles.data() + v * phase.cols();
      fill_discontinuity(static_cast<int>(planes[0].cols()), p, p + q_from_p, noise,
                         noise + q_from_p, variance, at(planes, v));
    }
  };
  fill(1, out.x);
  fill(phase.cols(), out.y);
  return out;
}

JumpProbabilities frequency_term(const ImageF& phase, const ImageF& reconstruction_cycles,
                                 int window_px, double sigma_cycles) {
  const auto half_precision = static_cast<float>(0.5 / (sigma_cycles * sigma_cycles));
  JumpProbabilities out = jump_nodes(phase.rows(), phase.cols());
  const auto fill = [&](const SideMedians& r, const SideMedians& a, Eigen::Index q_from_p,
                        std::array<ImageF, 3>& planes) {
    for (Eigen::Index v = 0; v < planes[0].rows(); ++v) {
      const float* p = phase.data() + v * phase.cols();
      const Eigen::Index node = v * planes[0].cols();
      fill_frequency(
          static_cast<int>(planes[0].cols()), p, p + q_from_p,
          {r.neg.data() + node, a.neg.data() + node, r.pos.data() + node, a.pos.data() + node},
          half_precision, at(planes, v));
    }
  };
  fill(side_medians_x(reconstruction_cycles, window_px), side_medians_x(phase, window_px), 1,
       out.x);
  fill(side_medians_y(reconstruction_cycles, window_px), side_medians_y(phase, window_px),
       phase.cols(), out.y);
  return out;
}

JumpProbabilities fuse(const JumpProbabilities& f_d, const JumpProbabilities& f_f, double c_d,
                       double c_f) {
  const Trust trust{static_cast<float>(c_d), static_cast<float>(c_f)};
  JumpProbabilities out = jump_nodes(f_d.x[0].rows(), f_d.y[0].cols());
  fill_fused(static_cast<int>(out.x[0].size()), at(f_d.x, 0), at(f_f.x, 0), trust, at(out.x, 0));
  fill_fused(static_cast<int>(out.y[0].size()), at(f_d.y, 0), at(f_f.y, 0), trust, at(out.y, 0));
  return out;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump/jump_evidence.hpp"

#include "common/fast_math.hpp"
#include "jump/configurations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// The inputs of the jump nodes of one row: phases of their pixels p and q, the noise of these
/// phases, and the medians of equation 3.
struct NodeRow {
  const float* phase_p;
  const float* phase_q;
  const float* noise_p;
  const float* noise_q;
  const float* r_neg = nullptr;  ///< medians of the reconstruction R̂
  const float* a_neg = nullptr;  ///< medians of the wrapped phase
  const float* r_pos = nullptr;
  const float* a_pos = nullptr;
};

/// JumpTerms in the form that the vectorised loops need.
struct Factors {
  float slope_variance;
  float half_precision;
  float trust_discontinuity;
  float trust_frequency;

  explicit Factors(const JumpTerms& terms)
      : slope_variance(static_cast<float>(terms.sigma_cycles * terms.sigma_cycles)),
        half_precision(0.5F / slope_variance),
        trust_discontinuity(static_cast<float>(terms.trust_discontinuity)),
        trust_frequency(static_cast<float>(terms.trust_frequency)) {}
};

/// The difference of wrap counts by both frequencies (equation 3), limited to −1 … 1.
[[gnu::always_inline]] inline float wraps_between(const NodeRow& row, int i) {
  const float wraps = std::abs(row.r_neg[i] - row.a_neg[i]) - std::abs(row.r_pos[i] - row.a_pos[i]);
  const float above = wraps > -1 ? wraps : -1.0F;
  return above < 1 ? above : 1.0F;
}

template <bool two_frequencies>
[[gnu::always_inline]] inline void fill_nodes(int nodes, const NodeRow& row, const Factors& factors,
                                              const Configurations<float>& out) {
  const float c_d = factors.trust_discontinuity;
  const float c_f = factors.trust_frequency;
  const float f_precision = factors.half_precision;
#pragma GCC ivdep
  for (int i = 0; i < nodes; ++i) {
    const float step = row.phase_q[i] - row.phase_p[i];
    const float variance =
        row.noise_p[i] * row.noise_p[i] + row.noise_q[i] * row.noise_q[i] + factors.slope_variance;
    const float d_precision = 0.5F / variance;
    const float wraps = two_frequencies ? wraps_between(row, i) : 0.0F;
    const auto product = [&](float configuration) {
      constexpr float least = 1e-6F;
      const float d_off = step - configuration;
      float both = 1 - c_d + c_d * exp_of_negative(-d_off * d_off * d_precision);
      if (two_frequencies) {
        const float f_off = wraps - configuration;
        both *= 1 - c_f + c_f * exp_of_negative(-f_off * f_off * f_precision);
      }
      return both > least ? both : least;
    };
    const float minus = product(-1);
    const float none = product(0);
    const float plus = product(1);
    // NaN if the node is absent, else 0. Adding it avoids a branch.
    const float absent = 0 * step;
    const float scale = 1 / (minus + none + plus) + absent;
    out.minus[i] = minus * scale;
    out.none[i] = none * scale;
    out.plus[i] = plus * scale;
  }
}

TOFMAP_VECTOR_CLONES void fill_from_one_frequency(int nodes, const NodeRow& row,
                                                  const Factors& factors,
                                                  const Configurations<float>& out) {
  fill_nodes<false>(nodes, NodeRow(row), Factors(factors), Configurations<float>(out));
}

TOFMAP_VECTOR_CLONES void fill_from_two_frequencies(int nodes, const NodeRow& row,
                                                    const Factors& factors,
                                                    const Configurations<float>& out) {
  fill_nodes<true>(nodes, NodeRow(row), Factors(factors), Configurations<float>(out));
}

/// Windows processed at a time, one in each lane.
constexpr int median_lanes = 64;

/// Medians of up to median_lanes windows; pixels[k] points to the k-th pixels of all windows.
/// `window` is memory for median_lanes numbers per pixel of a window.
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
  // Odd-even transposition sort of all lanes at once.
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

/// Medians of any number of windows. Advances `pixels` beyond the last window.
void line_medians(Eigen::Index windows, std::vector<const float*>& pixels,
                  std::vector<float>& window, float* medians) {
  window.resize(pixels.size() * median_lanes);
  for (Eigen::Index done = 0; done < windows; done += median_lanes) {
    const auto count = static_cast<int>(std::min<Eigen::Index>(windows - done, median_lanes));
    window_medians(count, pixels, window.data(), medians + done);
    for (const float*& pixel : pixels) pixel += count;
  }
}

/// Medians on both sides of the jump nodes between horizontal neighbours, one row at a time.
class RowMedians {
 public:
  RowMedians(const ImageF& image, int window_px)
      : image_(image),
        windows_(image.cols() + window_px - 1),
        line_(static_cast<std::size_t>(windows_ + window_px - 1), nan),
        medians_(static_cast<std::size_t>(windows_)),
        pixels_(static_cast<std::size_t>(window_px)) {}

  void move_to(Eigen::Index row) {
    const auto margin = static_cast<std::ptrdiff_t>(pixels_.size()) - 1;
    std::copy_n(image_.data() + row * image_.cols(), image_.cols(), line_.begin() + margin);
    for (std::size_t k = 0; k < pixels_.size(); ++k) pixels_[k] = line_.data() + k;
    line_medians(windows_, pixels_, window_, medians_.data());
  }

  // A window has the number of its last pixel: those of the node after pixel t end at t and t + k.
  const float* neg() const { return medians_.data(); }
  const float* pos() const { return medians_.data() + pixels_.size(); }

 private:
  const ImageF& image_;
  Eigen::Index windows_;
  std::vector<float> line_;  ///< a row, padded by NaN at both ends
  std::vector<float> medians_;
  std::vector<const float*> pixels_;
  std::vector<float> window_;
};

/// Medians on both sides of the jump nodes between vertical neighbours. Rows must be visited in
/// ascending order from the first one.
class ColumnMedians {
 public:
  ColumnMedians(const ImageF& image, int window_px)
      : image_(image),
        no_row_(static_cast<std::size_t>(image.cols()), nan),
        medians_(static_cast<std::size_t>((window_px + 1) * image.cols())),
        pixels_(static_cast<std::size_t>(window_px)) {}

  void move_to(Eigen::Index row) {
    row_ = row;
    for (; next_ <= row + window_px(); ++next_) {
      for (Eigen::Index k = 0; k < window_px(); ++k) {
        const Eigen::Index v = next_ - k;
        pixels_[static_cast<std::size_t>(k)] =
            v >= 0 && v < image_.rows() ? image_.data() + v * image_.cols() : no_row_.data();
      }
      line_medians(image_.cols(), pixels_, window_, ending_at(next_));
    }
  }

  const float* neg() { return ending_at(row_); }
  const float* pos() { return ending_at(row_ + window_px()); }

 private:
  Eigen::Index window_px() const { return static_cast<Eigen::Index>(pixels_.size()); }

  float* ending_at(Eigen::Index row) {
    return medians_.data() + row % (window_px() + 1) * image_.cols();
  }

  const ImageF& image_;
  Eigen::Index row_ = 0;
  Eigen::Index next_ = 0;  ///< last row of the windows to be computed next
  std::vector<float> no_row_;
  std::vector<float> medians_;  ///< ring buffer: windows that end at k + 1 successive rows
  std::vector<const float*> pixels_;
  std::vector<float> window_;
};

template <class Medians>
SideMedians side_medians(const ImageF& image, int window_px, Eigen::Index rows, Eigen::Index cols) {
  SideMedians out{ImageF(rows, cols), ImageF(rows, cols)};
  Medians medians(image, window_px);
  for (Eigen::Index v = 0; v < rows; ++v) {
    medians.move_to(v);
    std::copy_n(medians.neg(), cols, out.neg.data() + v * cols);
    std::copy_n(medians.pos(), cols, out.pos.data() + v * cols);
  }
  return out;
}

/// Computes the evidence of the jump nodes of one direction; the index of q is that of p plus
/// `q_from_p`.
template <class Medians>
void fill_direction(const ImageF& phase, const ImageF& noise_cycles, const ImageF& reconstruction,
                    const JumpTerms& terms, Eigen::Index q_from_p, std::array<ImageF, 3>& out) {
  const Factors factors(terms);
  const auto nodes = static_cast<int>(out[0].cols());
  const auto node_row = [&](Eigen::Index v) {
    const float* p = phase.data() + v * phase.cols();
    const float* noise = noise_cycles.data() + v * phase.cols();
    return NodeRow{p, p + q_from_p, noise, noise + q_from_p};
  };
  if (reconstruction.size() == 0) {
    for (Eigen::Index v = 0; v < out[0].rows(); ++v) {
      fill_from_one_frequency(nodes, node_row(v), factors, Configurations<float>(out, v));
    }
    return;
  }
  Medians r(reconstruction, terms.window_px);
  Medians a(phase, terms.window_px);
  for (Eigen::Index v = 0; v < out[0].rows(); ++v) {
    r.move_to(v);
    a.move_to(v);
    NodeRow row = node_row(v);
    row.r_neg = r.neg();
    row.a_neg = a.neg();
    row.r_pos = r.pos();
    row.a_pos = a.pos();
    fill_from_two_frequencies(nodes, row, factors, Configurations<float>(out, v));
  }
}

}  // namespace

SideMedians side_medians_x(const ImageF& image, int window_px) {
  return side_medians<RowMedians>(image, window_px, image.rows(),
                                  std::max<Eigen::Index>(image.cols() - 1, 0));
}

SideMedians side_medians_y(const ImageF& image, int window_px) {
  return side_medians<ColumnMedians>(image, window_px, std::max<Eigen::Index>(image.rows() - 1, 0),
                                     image.cols());
}

void find_jump_evidence(const ImageF& phase, const ImageF& noise_cycles,
                        const ImageF& reconstruction_cycles, const JumpTerms& terms,
                        JumpProbabilities& out) {
  for (ImageF& plane : out.x) {
    plane.resize(phase.rows(), std::max<Eigen::Index>(phase.cols() - 1, 0));
  }
  for (ImageF& plane : out.y) {
    plane.resize(std::max<Eigen::Index>(phase.rows() - 1, 0), phase.cols());
  }
  fill_direction<RowMedians>(phase, noise_cycles, reconstruction_cycles, terms, 1, out.x);
  fill_direction<ColumnMedians>(phase, noise_cycles, reconstruction_cycles, terms, phase.cols(),
                                out.y);
}

}  // namespace tofmap

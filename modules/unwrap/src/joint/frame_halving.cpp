// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/frame_halving.hpp"

#include "common/phasor_math.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// What is summed of two rows of pixels, column by column.
struct ColumnSums {
  std::vector<float> real;
  std::vector<float> imaginary;
  std::vector<float> noise_variance;

  explicit ColumnSums(std::size_t columns)
      : real(columns), imaginary(columns), noise_variance(columns) {}

  void clear() {
    for (std::vector<float>* sums : {&real, &imaginary, &noise_variance}) {
      std::ranges::fill(*sums, 0.0F);
    }
  }
};

/// Adds the phasors of a row at one frequency and the variances of their noise. `present` is 0 in
/// pixels that are left out, else 1.
TOFMAP_VECTOR_CLONES void add_row(int pixels, const float* phase, const float* amplitude,
                                  const float* sigma_cycles, const float* present,
                                  ColumnSums& sums_) {
  float* real = sums_.real.data();
  float* imaginary = sums_.imaginary.data();
  float* noise_variance = sums_.noise_variance.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const bool is_present = present[i] > 0;
    const float cycles = is_present ? phase[i] : 0.0F;
    const float length = is_present ? amplitude[i] : 0.0F;
    const float noise = is_present ? length * sigma_cycles[i] : 0.0F;
    real[i] += length * cos_of_cycles(cycles);
    imaginary[i] += length * sin_of_cycles(cycles);
    noise_variance[i] += noise * noise;
  }
}

/// Adds pairs of columns, in place.
void add_columns(std::vector<float>& sums) {
  for (std::size_t i = 0; i < sums.size() / 2; ++i) sums[i] = sums[2 * i] + sums[2 * i + 1];
}

/// The mean phasors of blocks, from their sums. `count` is the number of pixels of a block.
TOFMAP_VECTOR_CLONES void write_blocks(int blocks, const ColumnSums& sums_, const float* count,
                                       float* phase, float* amplitude, float* sigma_cycles) {
  const float* real = sums_.real.data();
  const float* imaginary = sums_.imaginary.data();
  const float* noise_variance = sums_.noise_variance.data();
  constexpr float least_length = 1e-6F;
#pragma GCC ivdep
  for (int i = 0; i < blocks; ++i) {
    const float a = real[i];
    const float b = imaginary[i];
    const float length = std::sqrt(a * a + b * b);
    const float longer = length > least_length ? length : least_length;
    const float angle = angle_in_cycles(a, b);
    const float known = angle == angle ? angle : 0.0F;  // phasors that cancel have no phase
    const float mean = longer / count[i];
    // Phase noise of the sum: its noise relative to its length.
    const float noise = std::sqrt(noise_variance[i]) / longer;
    const bool is_present = count[i] > 0;
    phase[i] = is_present ? known : nan;
    amplitude[i] = is_present ? mean : 0.0F;
    sigma_cycles[i] = is_present ? noise : nan;
  }
}

/// Marks the pixels of a row that have a phase at all frequencies.
void mark_present(const Frame& frame, Eigen::Index row, float* present) {
  std::fill_n(present, frame.cols(), 1.0F);
  for (const ImageF& phase : frame.phases) {
    const float* cycles = phase.data() + row * phase.cols();
    for (Eigen::Index u = 0; u < phase.cols(); ++u) {
      present[u] = std::isnan(cycles[u]) ? 0.0F : present[u];
    }
  }
}

}  // namespace

NoisyFrame halve(const Frame& frame, const PhaseSigma& sigma) {
  const Eigen::Index rows = (frame.rows() + 1) / 2;
  const Eigen::Index cols = (frame.cols() + 1) / 2;
  const std::size_t frequencies = frame.frequencies();
  NoisyFrame out;
  out.frame.index = frame.index;
  out.frame.timestamp_s = frame.timestamp_s;
  out.frame.phases.assign(frequencies, ImageF(rows, cols));
  out.frame.amplitudes.assign(frequencies, ImageF(rows, cols));
  out.sigma.cycles.assign(frequencies, ImageF(rows, cols));

  const auto columns = static_cast<std::size_t>(2 * cols);  // the last one may be padding
  const std::vector<float> ones(columns, 1.0F);
  std::array<std::vector<float>, 2> present{std::vector<float>(columns),
                                            std::vector<float>(columns)};
  std::vector<float> count(static_cast<std::size_t>(cols));
  ColumnSums sums(columns);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const auto used = static_cast<std::size_t>(std::min<Eigen::Index>(2, frame.rows() - 2 * row));
    std::ranges::fill(count, 0.0F);
    for (std::size_t k = 0; k < used; ++k) {
      mark_present(frame, 2 * row + static_cast<Eigen::Index>(k), present[k].data());
      for (std::size_t i = 0; i < count.size(); ++i) {
        count[i] += present[k][2 * i] + present[k][2 * i + 1];
      }
    }
    for (std::size_t f = 0; f < frequencies; ++f) {
      sums.clear();
      for (std::size_t k = 0; k < used; ++k) {
        const Eigen::Index at = (2 * row + static_cast<Eigen::Index>(k)) * frame.cols();
        add_row(static_cast<int>(frame.cols()), frame.phases[f].data() + at,
                frame.has_amplitude() ? frame.amplitudes[f].data() + at : ones.data(),
                sigma.cycles[f].data() + at, present[k].data(), sums);
      }
      for (std::vector<float>* column : {&sums.real, &sums.imaginary, &sums.noise_variance}) {
        add_columns(*column);
      }
      const Eigen::Index to = row * cols;
      write_blocks(static_cast<int>(cols), sums, count.data(), out.frame.phases[f].data() + to,
                   out.frame.amplitudes[f].data() + to, out.sigma.cycles[f].data() + to);
    }
  }
  return out;
}

}  // namespace tofmap

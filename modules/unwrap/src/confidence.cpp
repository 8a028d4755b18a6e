// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "confidence.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

/// The marginal of the configuration that makes this step; NaN where the node is absent.
float step_probability(const std::array<ImageF, 3>& marginal, Eigen::Index v, Eigen::Index u,
                       int step) {
  if (std::isnan(marginal[1](v, u))) return marginal[1](v, u);
  if (std::abs(step) > 1) return 0;
  return marginal[static_cast<std::size_t>(1 - step)](v, u);
}

/// Adds the probability of one node to both its pixels.
void add_node(float probability, float& sum_p, float& weight_p, float& sum_q, float& weight_q) {
  if (std::isnan(probability)) return;
  sum_p += probability;
  sum_q += probability;
  weight_p += 1;
  weight_q += 1;
}

}  // namespace

ImageF beat_confidence(const ImageU8& counts, const BeatCost& beat) {
  ImageF confidence = ImageF::Zero(counts.rows(), counts.cols());
  for (Eigen::Index v = 0; v < counts.rows(); ++v) {
    for (Eigen::Index u = 0; u < counts.cols(); ++u) {
      if (counts(v, u) == invalid_wrap_count) continue;
      float sum = 0;
      for (int n = 0; n < beat.count_a(); ++n) sum += std::exp(-beat(v, u, n));
      confidence(v, u) = std::exp(-beat(v, u, counts(v, u))) / sum;
    }
  }
  return confidence;
}

ImageF jump_confidence(const ImageU8& counts, const JumpProbabilities& marginals) {
  ImageF sum = ImageF::Zero(counts.rows(), counts.cols());
  ImageF weight = ImageF::Zero(counts.rows(), counts.cols());
  for (Eigen::Index v = 0; v < counts.rows(); ++v) {
    for (Eigen::Index u = 0; u < counts.cols(); ++u) {
      const int n = counts(v, u);
      if (u + 1 < counts.cols()) {
        add_node(step_probability(marginals.x, v, u, counts(v, u + 1) - n), sum(v, u), weight(v, u),
                 sum(v, u + 1), weight(v, u + 1));
      }
      if (v + 1 < counts.rows()) {
        add_node(step_probability(marginals.y, v, u, counts(v + 1, u) - n), sum(v, u), weight(v, u),
                 sum(v + 1, u), weight(v + 1, u));
      }
    }
  }
  const ImageF mean = (weight > 0).select(sum / weight, 0.5F);
  return (counts == invalid_wrap_count).select(0.0F, mean);
}

ImageF jump_and_beat_confidence(const ImageU8& counts, const JumpProbabilities& marginals,
                                const BeatCost& beat) {
  const ImageF b = beat_confidence(counts, beat);
  const ImageF j = jump_confidence(counts, marginals);
  const ImageF both = b * j;
  const ImageF neither = (1 - b) * (1 - j);
  // A beat that is sure and neighbours that are sure of the opposite leave nothing known.
  const ImageF odds = (both + neither > 0).select(both / (both + neither), 0.5F);
  return (counts == invalid_wrap_count).select(0.0F, odds);
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "jump/confidence.hpp"

#include "jump/configurations.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// One row of jump nodes: the marginals of their configurations, and the wrap counts of p and q.
struct NodeRow {
  Configurations<const float> marginal;
  const std::uint8_t* count_p;
  const std::uint8_t* count_q;
};

/// For each jump node, finds the probability of the step between the wrap counts of its pixels, and
/// whether the node is present (1 or 0). The probability of an absent node is 0.
TOFMAP_VECTOR_CLONES void find_steps(int nodes, const NodeRow& row_, float* steps, float* present) {
  const NodeRow row = row_;
#pragma GCC ivdep
  for (int i = 0; i < nodes; ++i) {
    const int step = static_cast<int>(row.count_q[i]) - static_cast<int>(row.count_p[i]);
    const float side = step == 1 ? row.marginal.minus[i] : step == -1 ? row.marginal.plus[i] : 0.0F;
    const float probability = step == 0 ? row.marginal.none[i] : side;
    const bool is_present = row.marginal.none[i] == row.marginal.none[i];
    steps[i] = is_present ? probability : 0.0F;
    present[i] = is_present ? 1.0F : 0.0F;
  }
}

/// The steps at the jump nodes of a row, padded by an absent node at both ends.
struct Steps {
  std::vector<float> probability;
  std::vector<float> present;

  explicit Steps(Eigen::Index nodes)
      : probability(static_cast<std::size_t>(nodes + 2), 0.0F), present(probability) {}

  void find(const std::array<ImageF, 3>& marginals, Eigen::Index row, const std::uint8_t* count_p,
            Eigen::Index q_from_p) {
    if (row >= marginals[0].rows()) {
      std::ranges::fill(probability, 0.0F);
      std::ranges::fill(present, 0.0F);
      return;
    }
    find_steps(static_cast<int>(marginals[0].cols()),
               {Configurations<const float>(marginals, row), count_p, count_p + q_from_p},
               probability.data() + 1, present.data() + 1);
  }
};

/// Mean probability over the jump nodes around each pixel of a row: nodes i and i + 1 of `across`
/// are left and right of pixel i, nodes i of `above` and `below` are above and below it.
TOFMAP_VECTOR_CLONES void fill_means(int pixels, const float* across, const float* across_present,
                                     const float* above, const float* above_present,
                                     const float* below, const float* below_present,
                                     const std::uint8_t* counts, float* means) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float sum = across[i] + across[i + 1] + above[i] + below[i];
    const float weight =
        across_present[i] + across_present[i + 1] + above_present[i] + below_present[i];
    const float mean = weight > 0 ? sum / weight : 0.5F;
    means[i] = counts[i] == invalid_wrap_count ? 0.0F : mean;
  }
}

/// Multiplies the odds of two probabilities; the result replaces `probability`.
TOFMAP_VECTOR_CLONES void multiply_odds(int pixels, const float* other, const std::uint8_t* counts,
                                        float* probability) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float both = other[i] * probability[i];
    const float neither = (1 - other[i]) * (1 - probability[i]);
    // If residual and neighbours contradict each other with certainty, nothing is known.
    const float odds = both + neither > 0 ? both / (both + neither) : 0.5F;
    probability[i] = counts[i] == invalid_wrap_count ? 0.0F : odds;
  }
}

}  // namespace

ImageF jump_confidence(const ImageU8& counts, const JumpProbabilities& marginals) {
  ImageF means(counts.rows(), counts.cols());
  Steps across(counts.cols() - 1);
  Steps above(counts.cols());
  Steps below(counts.cols());
  for (Eigen::Index v = 0; v < counts.rows(); ++v) {
    const std::uint8_t* row = counts.data() + v * counts.cols();
    across.find(marginals.x, v, row, 1);
    below.find(marginals.y, v, row, counts.cols());
    fill_means(static_cast<int>(counts.cols()), across.probability.data(), across.present.data(),
               above.probability.data() + 1, above.present.data() + 1, below.probability.data() + 1,
               below.present.data() + 1, row, means.data() + v * counts.cols());
    std::swap(above, below);
  }
  return means;
}

ImageF jump_and_residual_confidence(const ImageU8& counts, const JumpProbabilities& marginals,
                                    const ResidualCost& residual) {
  const ImageF by_residual = residual.probability(counts);
  ImageF confidence = jump_confidence(counts, marginals);
  multiply_odds(static_cast<int>(counts.size()), by_residual.data(), counts.data(),
                confidence.data());
  return confidence;
}

}  // namespace tofmap

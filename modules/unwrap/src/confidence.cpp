// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "confidence.hpp"

#include "vector_clones.hpp"

#include <vector>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

/// Nodes of one row: the marginals of their configurations, and the counts of their pixels.
struct NodeRow {
  const float* minus;
  const float* none;
  const float* plus;
  const std::uint8_t* count_p;
  const std::uint8_t* count_q;
};

/// Adds the probability of the step that the counts make to both pixels of each node, and 1 to
/// their weights. Nothing where the node is absent.
TOFMAP_VECTOR_CLONES void add_steps(int nodes, const NodeRow& row_, float* steps, float* present) {
  const NodeRow row = row_;
#pragma GCC ivdep
  for (int i = 0; i < nodes; ++i) {
    const int step = static_cast<int>(row.count_q[i]) - static_cast<int>(row.count_p[i]);
    const float side = step == 1 ? row.minus[i] : step == -1 ? row.plus[i] : 0.0F;
    const float probability = step == 0 ? row.none[i] : side;
    const bool is_present = row.none[i] == row.none[i];
    steps[i] = is_present ? probability : 0.0F;
    present[i] = is_present ? 1.0F : 0.0F;
  }
}

void add_to(float* sums, const std::vector<float>& terms) {
  for (std::size_t i = 0; i < terms.size(); ++i) sums[i] += terms[i];
}

}  // namespace

ImageF jump_confidence(const ImageU8& counts, const JumpProbabilities& marginals) {
  ImageF sum = ImageF::Zero(counts.rows(), counts.cols());
  ImageF weight = ImageF::Zero(counts.rows(), counts.cols());
  std::vector<float> steps;
  std::vector<float> present;
  const auto add_nodes = [&](const std::array<ImageF, 3>& nodes, Eigen::Index q_from_p) {
    steps.resize(static_cast<std::size_t>(nodes[0].cols()));
    present.resize(steps.size());
    for (Eigen::Index v = 0; v < nodes[0].rows(); ++v) {
      const Eigen::Index node = v * nodes[0].cols();
      const Eigen::Index p = v * counts.cols();
      add_steps(static_cast<int>(steps.size()),
                {nodes[0].data() + node, nodes[1].data() + node, nodes[2].data() + node,
                 counts.data() + p, counts.data() + p + q_from_p},
                steps.data(), present.data());
      for (const Eigen::Index pixel : {p, p + q_from_p}) {
        add_to(sum.data() + pixel, steps);
        add_to(weight.data() + pixel, present);
      }
    }
  };
  add_nodes(marginals.x, 1);
  add_nodes(marginals.y, counts.cols());
  const ImageF mean = (weight > 0).select(sum / weight, 0.5F);
  return (counts == invalid_wrap_count).select(0.0F, mean);
}

ImageF jump_and_beat_confidence(const ImageU8& counts, const JumpProbabilities& marginals,
                                const BeatCost& beat) {
  const ImageF b = beat.probability(counts);
  const ImageF j = jump_confidence(counts, marginals);
  const ImageF both = b * j;
  const ImageF neither = (1 - b) * (1 - j);
  // A beat that is sure and neighbours that are sure of the opposite leave nothing known.
  const ImageF odds = (both + neither > 0).select(both / (both + neither), 0.5F);
  return (counts == invalid_wrap_count).select(0.0F, odds);
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// The dot product Σ aᵢ bᵢ. The order of the additions does not depend on the processor.
float dot(std::size_t count, const float* a, const float* b);

/// Adds the normal equations of a weighted least-squares problem: Aᵀ W A to `information` and
/// Aᵀ W r to `gradient`. A has one column per coefficient, W is the diagonal matrix of the weights,
/// and r is `right`. Columns and `right` have one element per weight.
template <int terms>
void add_weighted_products(const std::array<const float*, terms>& columns,
                           const std::vector<float>& weight, const std::vector<float>& right,
                           Eigen::Matrix<double, terms, terms>& information,
                           Eigen::Matrix<double, terms, 1>& gradient) {
  std::vector<float> weighted(weight.size());
  for (int a = 0; a < terms; ++a) {
    const float* column = columns[static_cast<std::size_t>(a)];
    for (std::size_t i = 0; i < weight.size(); ++i) weighted[i] = weight[i] * column[i];
    for (int b = 0; b <= a; ++b) {
      information(a, b) +=
          dot(weight.size(), weighted.data(), columns[static_cast<std::size_t>(b)]);
      information(b, a) = information(a, b);
    }
    gradient[a] += dot(weight.size(), weighted.data(), right.data());
  }
}

}  // namespace tofmap

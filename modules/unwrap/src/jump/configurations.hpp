// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// Pointers into the planes of the three configurations of jump nodes, at the beginning of a row.
/// `Value` is float or const float.
template <class Value>
struct Configurations {
  Value* minus;  ///< configuration −1: the wrap count grows by one
  Value* none;   ///< configuration 0
  Value* plus;   ///< configuration +1

  template <class Planes>
  Configurations(Planes& planes, Eigen::Index row)
      : minus(planes[0].data() + row * planes[0].cols()),
        none(planes[1].data() + row * planes[1].cols()),
        plus(planes[2].data() + row * planes[2].cols()) {}
};

}  // namespace tofmap

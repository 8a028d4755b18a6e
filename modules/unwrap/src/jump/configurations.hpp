// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// The planes of the three configurations of jump nodes, from some row of nodes on. `Value` is
/// float, or const float to read.
template <class Value>
struct Configurations {
  Value* minus;
  Value* none;
  Value* plus;

  template <class Planes>
  Configurations(Planes& planes, Eigen::Index row)
      : minus(planes[0].data() + row * planes[0].cols()),
        none(planes[1].data() + row * planes[1].cols()),
        plus(planes[2].data() + row * planes[2].cols()) {}
};

}  // namespace tofmap

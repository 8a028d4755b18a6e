// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tofmap/mapping/map_content.hpp"
#include "tofmap/mapping/motion_uncertainty.hpp"

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// That a camera moves steadily through three frames that follow each other: the expected twist,
/// along the axes of the world, of the last one from where constant velocity puts it is zero.
struct MotionTerm {
  std::array<std::size_t, 3> frames = {};  ///< indices in MapContent::frames
  double share = 1;  ///< time from the second to the third frame, as a share of that before
  Eigen::Matrix<double, 6, 1> change = Eigen::Matrix<double, 6, 1>::Zero();  ///< the present twist
  Eigen::Matrix<double, 6, 1> sigmas = Eigen::Matrix<double, 6, 1>::Ones();  ///< of the twist
};

/// The terms of the motion of a recording around frames that surfaces leave more uncertain, in some
/// direction, than its motion does. `motion` learns how steady it is, in each path anew.
std::vector<MotionTerm> motion_terms(const MapContent& content, int recording,
                                     const MotionUncertainty& motion);

}  // namespace tofmap

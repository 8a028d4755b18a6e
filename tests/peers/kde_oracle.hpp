// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "peers/kde_unwrap.hpp"

namespace tofmap::peers {

/// kde_unwrap() by its equations, in double precision and with the functions of the C library.
/// Without smoothing and phase biases, for the frequencies of the Kinect v2.
KdeResult kde_by_equations(const ThreePhases& phases, const KdeOptions& options);

}  // namespace tofmap::peers

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "score.hpp"

namespace tofmap::bench {

/// PCL's filters applied to range images: ShadowPoints with normals from integral images,
/// StatisticalOutlierRemoval, RadiusOutlierRemoval and FastBilateralFilter. Their names contain
/// their parameters. Their times include the conversion to clouds and back.
std::vector<MeasuredFilter> pcl_filters();

}  // namespace tofmap::bench

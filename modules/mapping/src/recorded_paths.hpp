// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tofmap/mapping/map_content.hpp"

#include <cstddef>
#include <vector>

namespace tofmap {

/// The paths of a recording: frames of one map that follow each other without a gap in which the
/// camera may have changed its motion. Indices in MapContent::frames.
std::vector<std::vector<std::size_t>> recorded_paths(const MapContent& content, int recording);

/// Whether a frame is that of its keyframe.
bool is_of_keyframe(const RegisteredFrame& frame, const KeyframeGraph& keyframes);

}  // namespace tofmap

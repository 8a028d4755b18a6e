// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tofmap {

/// Gap between the parts of a composed picture.
inline constexpr int picture_gap_px = 16;

}  // namespace tofmap

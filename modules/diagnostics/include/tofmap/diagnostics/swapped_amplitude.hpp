// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// Whether the phase images of a recording are amplitudes, and its amplitude images phases. Phases
/// of two frequencies differ by nearly a cycle where one has wrapped and the other has not, while
/// amplitudes of both are similar everywhere. Returns false if nothing wraps, or without
/// amplitudes.
bool looks_like_swapped_amplitude(const std::vector<Frame>& frames);

/// A warning, with the remedy, if looks_like_swapped_amplitude(); otherwise empty.
std::optional<std::string> swapped_amplitude_warning(const std::vector<Frame>& frames);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/acquisition/correlation/correlation_description.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// The dark images of a description by frequency and step, in units of the values. Those that are
/// given once for several frequencies or steps are repeated. Empty if the description has none.
/// Throws InputError if a file is missing, damaged or of another size.
std::vector<std::vector<ImageF>> dark_images(const CorrelationDescription& description);

/// The phase offsets of every pixel in cycles, by frequency. Empty if the description has none.
/// Throws as dark_images() does.
std::vector<ImageF> phase_offset_images(const CorrelationDescription& description);

}  // namespace tofmap

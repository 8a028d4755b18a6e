// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace tofmap {

/// The number with the fewest digits that read back as the same bits.
std::string shortest(double number);

/// Numbers as a YAML list: "[1.5, 2]".
std::string list_text(const std::vector<double>& numbers);

}  // namespace tofmap

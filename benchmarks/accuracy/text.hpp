// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <fmt/format.h>

namespace tofmap::accuracy {

/// "58 / 60"
inline std::string count_of(int count, int all) { return fmt::format("{} / {}", count, all); }

}  // namespace tofmap::accuracy

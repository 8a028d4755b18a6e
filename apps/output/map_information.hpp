// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tofmap::app {

/// Prints what a map file contains. Throws InputError, which names the file, if it cannot be read
/// or is damaged.
void print_map_information(const std::filesystem::path& file);

}  // namespace tofmap::app

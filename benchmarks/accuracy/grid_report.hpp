// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grid.hpp"

#include <filesystem>

namespace tofmap::accuracy {

/// Prints Markdown tables: wrong wraps by kind and size of error, averaged over scenes and seeds;
/// the number of rows that meet each condition; and the rows that miss it by most.
void print_grid(const Grid& grid);

/// Writes all rows with all figures and conditions. Throws InputError if the file cannot be
/// written.
void write_grid_csv(const Grid& grid, const std::filesystem::path& file);

}  // namespace tofmap::accuracy

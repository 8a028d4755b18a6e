// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tofmap::app {

/// The map file that an argument names: the file itself, or map.db in a folder. Throws InputError
/// if there is none.
std::filesystem::path map_file_in(const std::filesystem::path& argument);

/// Throws UsageError if the map file is in the folder of a result, which would replace it.
void refuse_to_replace(const std::filesystem::path& map_file, const std::filesystem::path& out);

/// Throws UsageError if `out` holds a map of several recordings. For commands whose result does not
/// go on with one: it took long to make, and is easily lost by a forgotten --onto.
void refuse_to_replace_grown_map(const std::filesystem::path& out);

/// Whether an argument names a map: a file that ends in .db, or a folder with a map file that is no
/// recording.
bool is_map(const std::filesystem::path& argument);

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tofmap {

/// A path that a file of a recording names, relative to the folder of the recording. Throws
/// InputError if it leads out of the folder; the message calls the folder that of `what`.
std::filesystem::path inner_path(const std::string& text, const std::string& what);

}  // namespace tofmap

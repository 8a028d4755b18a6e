// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tofmap {

/// Throws InputError if `path` exists but is not a regular file: a folder, or a pipe, which could
/// keep a reader waiting for ever. Does nothing if `path` does not exist, because the caller that
/// opens it has a better message.
void refuse_no_file(const std::filesystem::path& path);

/// The extension of a file in lower case, with its dot: ".ply" for `a/b.PLY`.
std::string lower_extension(const std::filesystem::path& file);

/// The words of a line, which are separated by white space.
std::vector<std::string> words_of_line(const std::string& line);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tofmap {

/// Throws InputError if `path` exists but is not a regular file: a folder, or a pipe, which could
/// keep a reader waiting for ever. Does nothing if `path` does not exist, because the caller that
/// opens it has a better message.
void refuse_no_file(const std::filesystem::path& path);

}  // namespace tofmap

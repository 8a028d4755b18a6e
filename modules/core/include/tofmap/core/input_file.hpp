// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tofmap {

/// Throws InputError that names what is there if it is something else than a file: a folder, or a
/// pipe, which could keep a reader waiting for ever. What is missing passes: those who open it know
/// what it should have been.
void refuse_no_file(const std::filesystem::path& path);

}  // namespace tofmap

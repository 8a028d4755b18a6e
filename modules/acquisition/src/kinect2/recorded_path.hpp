// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tofmap::kinect2 {

/// The path that a recording names, relative to the recording's folder. Throws InputError if it is
/// empty, not valid or leads out of the folder.
std::filesystem::path recorded_path(const std::string& text);

}  // namespace tofmap::kinect2

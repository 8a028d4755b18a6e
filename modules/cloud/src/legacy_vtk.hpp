// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// Reads the positions of a legacy VTK file (.vtk, ASCII or binary) of any kind that has a POINTS
/// section. Other sections are not read. Empty if there is no POINTS section. Throws InputError,
/// which does not name the file, if the file is no legacy VTK file or is cut off.
///
/// VTK's own reader is not used: it crashes on damaged files, and takes the points that a file
/// lacks from uninitialised memory.
std::vector<Eigen::Vector3d> read_legacy_vtk(const std::filesystem::path& file);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include <tofmap/core/camera.hpp>

namespace tofmap::kinect2 {

/// What the manifest.json of a recording says.
struct Manifest {
  std::string serial;    ///< of the device; empty if the manifest has none
  std::string firmware;  ///< of the device; empty if the manifest has none
  CameraModel camera;
  std::filesystem::path p0 = "calibration/p0.bin";  ///< relative to the recording's folder
};

/// Reads a manifest of version 1 or 2. Throws InputError, which names the file and the line or key,
/// if the file cannot be read, is not JSON, is of another version, holds packets in another
/// encoding or times of another clock, or describes no camera.
Manifest read_manifest(const std::filesystem::path& file);

/// The text of a manifest of version 2. It has intrinsics of a color camera, which other programs
/// expect, but all of them are 0.
std::string manifest_text(const Manifest& manifest);

}  // namespace tofmap::kinect2

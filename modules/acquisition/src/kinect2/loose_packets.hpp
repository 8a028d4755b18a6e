// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "listed_packets.hpp"

#include <filesystem>
#include <vector>

namespace tofmap::kinect2 {

/// The packets <prefix>_<timestamp>_<sequence>.depth of a folder, in the order of their timestamps,
/// also where these wrap. Files with the ending .depth whose names have another form follow as
/// damaged packets. Throws InputError if the folder cannot be read.
std::vector<ListedPacket> list_loose_packets(const std::filesystem::path& folder);

}  // namespace tofmap::kinect2

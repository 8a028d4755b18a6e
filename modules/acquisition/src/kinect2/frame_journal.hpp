// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "listed_packets.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tofmap::kinect2 {

/// The depth packets that the frames.ndjson of a recording lists.
struct FrameJournal {
  std::vector<ListedPacket> packets;
  std::string unfinished_line;  ///< place of a last line that is cut off; empty if there is none
};

/// Reads frames.ndjson in a recording's folder. Lines that cannot be read become damaged packets,
/// except a last line that is cut off in a recording that is not complete. Throws InputError if the
/// file cannot be read.
FrameJournal read_frame_journal(const std::filesystem::path& folder, bool is_complete);

/// The line of frames.ndjson, with its line feed, for a depth packet. `index` is the packet's
/// position in the recording, `path` is relative to the recording's folder, and `arrival_us` are
/// microseconds since the beginning.
std::string journal_line(std::uint64_t index, const std::string& path, const ListedPacket& packet,
                         std::uint64_t arrival_us);

}  // namespace tofmap::kinect2

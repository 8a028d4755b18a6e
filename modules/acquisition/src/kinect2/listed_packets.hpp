// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/acquisition/kinect2/recording.hpp>

namespace tofmap::kinect2 {

/// Steps of the camera's clock in a second.
inline constexpr double ticks_per_s = 8000;

/// A packet as a recording lists it.
struct ListedPacket {
  std::filesystem::path file = {};
  std::uint32_t ticks = 0;     ///< of the camera's clock, modulo 2^32
  std::uint32_t sequence = 0;  ///< modulo 2^32
  bool is_known = true;        ///< false if ticks and sequence could not be read
  std::string damage = {};
};

/// Why the file of a packet cannot be one. Empty if it exists and has the size of a packet.
std::string damage_of_file(const std::filesystem::path& file);

/// Packets with their timestamps, and the number of frames between them that were never recorded.
struct TimedPackets {
  std::vector<RecordedPacket> packets;
  std::uint64_t never_recorded = 0;
};

/// Unwraps the timestamps of packets in the order in which they are listed, and marks packets as
/// damaged whose timestamp or sequence number does not increase.
TimedPackets timed(std::vector<ListedPacket> listed);

}  // namespace tofmap::kinect2

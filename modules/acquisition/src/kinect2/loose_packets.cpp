// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "loose_packets.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>
#include <tuple>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap::kinect2 {
namespace {

/// The number that follows the last underscore of a name, which is taken off. Empty if there is no
/// number of 32 bits.
std::optional<std::uint32_t> take_last_number(std::string_view& name) {
  const std::size_t underscore = name.rfind('_');
  if (underscore == std::string_view::npos) return std::nullopt;
  const std::string_view digits = name.substr(underscore + 1);
  name = name.substr(0, underscore);
  std::uint32_t number = 0;
  const char* end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

ListedPacket packet_of_name(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  std::string_view name = stem;
  const std::optional<std::uint32_t> sequence = take_last_number(name);
  const std::optional<std::uint32_t> ticks = take_last_number(name);
  if (!sequence || !ticks) {
    return {.file = file,
            .is_known = false,
            .damage = file.string() +
                      ": its name must be <prefix>_<timestamp>_<sequence>.depth, with numbers "
                      "from 0 to 4294967295"};
  }
  return {.file = file, .ticks = *ticks, .sequence = *sequence, .damage = damage_of_file(file)};
}

/// The packet with which a recording begins, if its timestamps are sorted but may have wrapped: the
/// one after the largest gap, if the gap is more than half of the clock's period.
std::vector<ListedPacket>::iterator beginning(std::vector<ListedPacket>& sorted) {
  constexpr std::uint32_t half_period = 1U << 31U;
  for (auto packet = sorted.begin(); packet != sorted.end(); ++packet) {
    if (packet != sorted.begin() && packet->ticks - (packet - 1)->ticks > half_period) {
      return packet;
    }
  }
  return sorted.begin();
}

}  // namespace

std::vector<ListedPacket> list_loose_packets(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<ListedPacket> packets;
  std::vector<ListedPacket> unnamed;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (lower_extension(entry->path()) != ".depth") continue;
    ListedPacket packet = packet_of_name(entry->path());
    (packet.is_known ? packets : unnamed).push_back(std::move(packet));
  }
  if (error) throw InputError(folder.string() + ": cannot be read: " + error.message());
  std::ranges::sort(packets, {}, [](const ListedPacket& packet) {
    return std::tie(packet.ticks, packet.sequence, packet.file);
  });
  std::rotate(packets.begin(), beginning(packets), packets.end());
  std::ranges::sort(unnamed, {}, &ListedPacket::file);
  packets.insert(packets.end(), unnamed.begin(), unnamed.end());
  return packets;
}

}  // namespace tofmap::kinect2

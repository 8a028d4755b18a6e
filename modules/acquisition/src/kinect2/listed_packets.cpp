// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "listed_packets.hpp"

#include <algorithm>
#include <optional>
#include <system_error>

#include <tofmap/acquisition/kinect2/packet.hpp>

namespace tofmap::kinect2 {
namespace {

/// True if counter a is later than b. Counters wrap at 2^32, so that the shorter way round decides.
bool is_later(std::uint32_t a, std::uint32_t b) { return static_cast<std::int32_t>(a - b) > 0; }

bool is_later(const ListedPacket& a, const ListedPacket& b) {
  return is_later(a.ticks, b.ticks) && is_later(a.sequence, b.sequence);
}

/// Why a packet cannot follow `latest`.
std::string order_damage(const ListedPacket& packet, const ListedPacket& latest,
                         const char* relation) {
  const bool same_place = packet.sequence == latest.sequence && packet.ticks == latest.ticks;
  return packet.file.string() + ": its sequence number " + std::to_string(packet.sequence) +
         " and timestamp " + std::to_string(packet.ticks) + " are not " + relation + " " +
         std::to_string(latest.sequence) + " and " + std::to_string(latest.ticks) +
         (same_place ? "; the frame is listed twice" : "");
}

/// Marks packets that are out of order, and returns those in order. Of two packets in the wrong
/// order, the second one is marked, unless it is in order with the packets before and after the
/// pair: then the first one is marked, as when a single timestamp is far ahead of all others.
std::vector<const ListedPacket*> mark_out_of_order(std::vector<ListedPacket>& listed) {
  std::vector<ListedPacket*> known;
  for (ListedPacket& packet : listed) {
    if (packet.is_known) known.push_back(&packet);
  }
  const auto mark = [](ListedPacket& packet, const ListedPacket& other, const char* relation) {
    if (packet.damage.empty()) packet.damage = order_damage(packet, other, relation);
  };
  std::vector<const ListedPacket*> in_order;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const ListedPacket* latest = in_order.empty() ? nullptr : in_order.back();
    const auto follows = [&](std::size_t j) {
      return latest == nullptr || is_later(*known[j], *latest);
    };
    const bool is_ahead = i + 2 < known.size() && follows(i + 1) &&
                          is_later(*known[i + 2], *known[i + 1]) &&
                          !is_later(*known[i + 2], *known[i]);
    if (!follows(i)) {
      mark(*known[i], *latest, "both later than");
    } else if (is_ahead) {
      mark(*known[i], *known[i + 1], "both earlier than the next ones,");
    } else {
      in_order.push_back(known[i]);
    }
  }
  return in_order;
}

/// Number of sequence numbers between the packets that no entry of the list has. Entries that
/// cannot be read may be of any of them.
std::uint64_t missing_between(const std::vector<const ListedPacket*>& in_order,
                              std::size_t listed_count) {
  std::uint64_t missing = 0;
  for (std::size_t i = 1; i < in_order.size(); ++i) {
    missing += in_order[i]->sequence - in_order[i - 1]->sequence - 1;
  }
  const std::uint64_t others = listed_count - in_order.size();
  return missing > others ? missing - others : 0;
}

}  // namespace

std::string damage_of_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return file.string() + ": no such file";
  if (!std::filesystem::is_regular_file(status)) return file.string() + ": is not a regular file";
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return file.string() + ": cannot be read: " + error.message();
  if (size == packet_bytes) return "";
  return file.string() + ": has " + std::to_string(size) + " bytes; a depth packet has " +
         std::to_string(packet_bytes) + (size < packet_bytes ? ", so it is truncated" : "");
}

TimedPackets timed(std::vector<ListedPacket> listed) {
  const std::vector<const ListedPacket*> in_order = mark_out_of_order(listed);
  TimedPackets result;
  result.never_recorded = missing_between(in_order, listed.size());
  std::uint64_t ticks = in_order.empty() ? 0 : in_order.front()->ticks;
  std::size_t next = 0;  // of the packets in order
  for (const ListedPacket& packet : listed) {
    if (next < in_order.size() && in_order[next] == &packet) {
      if (next > 0) ticks += packet.ticks - in_order[next - 1]->ticks;
      ++next;
    }
    result.packets.push_back({.index = static_cast<int>(result.packets.size()),
                              .file = packet.file,
                              .timestamp_s = static_cast<double>(ticks) / ticks_per_s,
                              .sequence = packet.sequence,
                              .damage = packet.damage});
  }
  return result;
}

}  // namespace tofmap::kinect2

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "frame_journal.hpp"

#include "recorded_path.hpp"
#include "shown_json.hpp"

#include <fstream>
#include <limits>
#include <optional>
#include <set>

#include <tofmap/acquisition/kinect2/packet.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap::kinect2 {
namespace {

using Json = nlohmann::json;

constexpr const char* journal_name = "frames.ndjson";

/// A whole number of 32 bits. Throws InputError, which names the key, if it is none.
std::uint32_t counter(const Json& line, const char* key) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  const auto value = line.find(key);
  if (value == line.end()) throw InputError(std::string(key) + " is missing");
  if (!value->is_number_unsigned() || value->get<std::uint64_t>() > most) {
    throw InputError(std::string(key) + " must be a whole number from 0 to " +
                     std::to_string(most) + ", got " + shown(*value));
  }
  return value->get<std::uint32_t>();
}

std::string text(const Json& line, const char* key) {
  const auto value = line.find(key);
  if (value == line.end() || !value->is_string()) {
    throw InputError(std::string(key) + " must be a text");
  }
  return value->get<std::string>();
}

/// The packet of a line whose entries are of the right kind. Empty for a color frame. Throws
/// InputError if the line cannot be read or names no path inside of the recording.
std::optional<ListedPacket> packet_of_line(const std::string& line,
                                           const std::filesystem::path& folder) {
  const Json entry = Json::parse(line, nullptr, false);
  if (!entry.is_object()) throw InputError("is not a JSON object; the line is damaged");
  const std::string stream = text(entry, "stream");
  if (stream == "color") return std::nullopt;
  if (stream != "depth") {
    throw InputError("stream must be color or depth, got " + shown(stream));
  }
  ListedPacket packet;
  packet.file = folder / recorded_path(text(entry, "path"));
  packet.ticks = counter(entry, "device_timestamp");
  packet.sequence = counter(entry, "sequence");
  const std::uint32_t byte_count = counter(entry, "byte_count");
  packet.damage = damage_of_file(packet.file);
  if (packet.damage.empty() && byte_count != packet_bytes) {
    packet.damage = "byte_count is " + std::to_string(byte_count) + "; a depth packet has " +
                    std::to_string(packet_bytes) + " bytes";
  }
  return packet;
}

}  // namespace

FrameJournal read_frame_journal(const std::filesystem::path& folder, bool is_complete) {
  const std::filesystem::path file = folder / journal_name;
  refuse_no_file(file);
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw InputError(file.string() +
                     ": cannot be read; a recording lists its frames in frames.ndjson");
  }
  FrameJournal journal;
  std::set<std::filesystem::path> files;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const bool is_cut_off = in.eof();  // no line feed at the end
    if (words_of_line(line).empty()) continue;
    const std::string place = std::string(journal_name) + ":" + std::to_string(number);
    try {
      std::optional<ListedPacket> packet = packet_of_line(line, folder);
      if (!packet) continue;
      if (!packet->damage.empty()) packet->damage = place + ": " + packet->damage;
      if (!files.insert(packet->file).second) {
        packet->damage = place + ": " + packet->file.string() + " is listed twice";
      }
      journal.packets.push_back(*std::move(packet));
    } catch (const InputError& error) {
      if (is_cut_off && !is_complete) {
        journal.unfinished_line = place;
      } else {
        journal.packets.push_back(
            {.is_known = false, .damage = folder.string() + "/" + place + ": " + error.what()});
      }
    }
  }
  if (in.bad()) throw InputError(file.string() + ": cannot be read to its end");
  return journal;
}

std::string journal_line(std::uint64_t index, const std::string& path, const ListedPacket& packet,
                         std::uint64_t arrival_us) {
  const nlohmann::ordered_json line = {{"index", index},
                                       {"stream", "depth"},
                                       {"path", path},
                                       {"byte_count", packet_bytes},
                                       {"device_timestamp", packet.ticks},
                                       {"sequence", packet.sequence},
                                       {"arrival_offset_us", arrival_us}};
  return line.dump() + "\n";
}

}  // namespace tofmap::kinect2

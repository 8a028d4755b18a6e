// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/kinect2/recording_writer.hpp"

#include "binary_file.hpp"
#include "frame_journal.hpp"
#include "manifest.hpp"

#include <cmath>
#include <cstdio>
#include <span>
#include <system_error>

#include <tofmap/acquisition/kinect2/intrinsics.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap::kinect2 {
namespace {

constexpr double longest_pause_s = 3 * 86400.0;  // below half of the clock's period of 6.2 days
constexpr double latest_s = 1e12;                // keeps the ticks far from the end of 64 bits

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be created: " + error.message());
}

void refuse_full_folder(const std::filesystem::path& folder) {
  std::error_code error;
  const bool is_empty = std::filesystem::is_empty(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be read: " + error.message());
  if (!is_empty) {
    throw InputError(folder.string() + ": is not empty; a recording needs a folder of its own");
  }
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  write_whole(file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

/// Path of a packet, relative to the recording's folder.
std::string packet_path(int index) {
  char name[40];
  std::snprintf(name, sizeof name, "frames/depth/%010d.depth", index);
  return name;
}

[[noreturn]] void fail_to_list(const std::filesystem::path& folder) {
  throw InputError((folder / "frames.ndjson").string() +
                   ": cannot be written; is the disk full, or is permission missing?");
}

}  // namespace

RecordingWriter::RecordingWriter(std::filesystem::path folder, const CameraModel& camera,
                                 const P0Tables& p0, const std::string& serial)
    : folder_(std::move(folder)) {
  if (camera.width_px != image_width_px || camera.height_px != image_height_px) {
    throw UsageError("the camera of a Kinect v2 has 512 x 424 pixels, got " +
                     std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px));
  }
  for (const double focal_px : {camera.fx_px, camera.fy_px}) {
    if (is_possible_focal_length(focal_px)) continue;
    throw UsageError("the focal length of a Kinect v2 is about 365 pixels, from 200 to 600, got " +
                     std::to_string(focal_px));
  }
  if (serial.empty()) throw UsageError("the serial of a recording must not be empty");
  validate(camera);
  make_folder(folder_);
  refuse_full_folder(folder_);
  const Manifest manifest{.serial = serial, .firmware = "unknown", .camera = camera};
  make_folder((folder_ / manifest.p0).parent_path());
  make_folder((folder_ / packet_path(0)).parent_path());
  write_p0_tables(folder_ / manifest.p0, p0);
  write_text(folder_ / "manifest.json", manifest_text(manifest));
  journal_.open(folder_ / "frames.ndjson", std::ios::binary);
  if (!journal_) fail_to_list(folder_);
}

void RecordingWriter::add(const Measurements& measurements, double timestamp_s) {
  if (!(timestamp_s >= 0 && timestamp_s <= latest_s)) {
    throw UsageError("timestamps of packets must be at least 0 s, got " +
                     std::to_string(timestamp_s));
  }
  if (!journal_.is_open())
    throw UsageError(folder_.string() + ": is finished; add packets before that");
  const auto ticks = static_cast<std::uint64_t>(std::llround(timestamp_s * ticks_per_s));
  const bool is_next = ticks > last_ticks_ &&
                       static_cast<double>(ticks - last_ticks_) < longest_pause_s * ticks_per_s;
  if (first_ticks_ && !is_next) {
    throw UsageError(
        "timestamps of packets must increase, by less than 3 days: " + std::to_string(timestamp_s) +
        " s follows " + std::to_string(static_cast<double>(last_ticks_) / ticks_per_s) + " s");
  }
  const std::string path = packet_path(count_);
  write_whole(folder_ / path, encode_packet(measurements));
  if (!first_ticks_) first_ticks_ = ticks;
  constexpr std::uint64_t us_per_tick = 125;
  // The counters of a Kinect have 32 bits and start again from 0.
  const ListedPacket packet{.ticks = static_cast<std::uint32_t>(ticks),
                            .sequence = static_cast<std::uint32_t>(count_)};
  journal_ << journal_line(count_, path, packet, (ticks - *first_ticks_) * us_per_tick)
           << std::flush;
  if (!journal_) fail_to_list(folder_);
  last_ticks_ = ticks;
  ++count_;
}

void RecordingWriter::finish() {
  if (!journal_.is_open()) return;
  journal_.close();
  if (!journal_) fail_to_list(folder_);
  write_text(folder_ / "recording.complete", "complete\n");
}

}  // namespace tofmap::kinect2

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/kinect2/recording.hpp"

#include "frame_journal.hpp"
#include "listed_packets.hpp"
#include "loose_packets.hpp"
#include "manifest.hpp"

#include <system_error>

#include <tofmap/acquisition/kinect2/intrinsics.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap::kinect2 {
namespace {

bool is_there(const std::filesystem::path& path) {
  std::error_code unknown;
  return std::filesystem::exists(path, unknown);
}

void refuse_no_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return;
  throw InputError(folder.string() +
                   (is_there(folder)
                        ? ": is a file; give its folder, with "
                        : ": no such folder; a recording of a Kinect v2 is one with ") +
                   "manifest.json and frames.ndjson or with packets "
                   "<prefix>_<timestamp>_<sequence>.depth in it");
}

void assume_camera(Recording& recording) {
  recording.camera = camera_of(typical_intrinsics);
  recording.camera_is_assumed = true;
}

/// The P0 tables beside loose packets, under one of the names that programs give them.
std::filesystem::path loose_p0_file(const std::filesystem::path& folder) {
  for (const char* name : {"p0.bin", "p0tables.dat", "calibration/p0.bin"}) {
    if (is_there(folder / name)) return folder / name;
  }
  return folder / "p0.bin";
}

/// Opens a recording directory, except for its P0 tables.
Recording open_directory(const std::filesystem::path& folder) {
  Recording recording;
  recording.folder = folder;
  std::error_code unknown;
  const std::filesystem::path marker = folder / "recording.complete";
  recording.is_complete = is_there(marker) && !std::filesystem::is_empty(marker, unknown);
  Manifest manifest;
  if (!is_there(folder / "manifest.json") && recording.is_complete) {
    throw InputError((folder / "manifest.json").string() +
                     ": no such file, though the recording is complete; copy it from the original, "
                     "or remove recording.complete to import with typical intrinsics");
  }
  if (is_there(folder / "manifest.json")) {
    manifest = read_manifest(folder / "manifest.json");
    recording.camera = manifest.camera;
    recording.serial = manifest.serial;
  } else {
    assume_camera(recording);
  }
  recording.p0_file = folder / manifest.p0;
  FrameJournal journal = read_frame_journal(folder, recording.is_complete);
  recording.unfinished_line = journal.unfinished_line;
  TimedPackets packets = timed(std::move(journal.packets));
  recording.packets = std::move(packets.packets);
  recording.never_recorded = packets.never_recorded;
  if (recording.packets.empty()) {
    throw InputError((folder / "frames.ndjson").string() +
                     ": lists no depth packets; record at least one, with the depth stream on");
  }
  return recording;
}

/// Opens a directory of loose packets, except for its P0 tables.
Recording open_loose(const std::filesystem::path& folder) {
  Recording recording;
  recording.folder = folder;
  assume_camera(recording);
  recording.p0_file = loose_p0_file(folder);
  TimedPackets packets = timed(list_loose_packets(folder));
  recording.packets = std::move(packets.packets);
  recording.never_recorded = packets.never_recorded;
  if (recording.packets.empty()) {
    throw InputError(
        folder.string() +
        ": is no recording of a Kinect v2; one has manifest.json and frames.ndjson, or "
        "packets <prefix>_<timestamp>_<sequence>.depth");
  }
  return recording;
}

}  // namespace

Recording open_recording(const std::filesystem::path& folder,
                         const std::filesystem::path& p0_file) {
  refuse_no_folder(folder);
  const bool is_directory =
      is_there(folder / "frames.ndjson") || is_there(folder / "manifest.json");
  Recording recording = is_directory ? open_directory(folder) : open_loose(folder);
  if (!p0_file.empty()) recording.p0_file = p0_file;
  recording.p0 = read_p0_tables(recording.p0_file);
  return recording;
}

}  // namespace tofmap::kinect2

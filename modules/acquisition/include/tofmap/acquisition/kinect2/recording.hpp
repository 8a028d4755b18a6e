// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/acquisition/kinect2/p0_tables.hpp>
#include <tofmap/core/camera.hpp>

namespace tofmap::kinect2 {

/// One depth packet of a recording.
struct RecordedPacket {
  int index = 0;               ///< position in the list of packets, from 0
  std::filesystem::path file;  ///< to read with read_packet(); empty if it is not known
  /// Seconds of the camera's clock, which counts steps of 0.125 ms in 32 bits. The time goes on
  /// where the count starts again from 0. A packet whose own time is not known or wrong has that of
  /// the nearest packet before it that is in order or, at the beginning, of the first such packet.
  double timestamp_s = 0;
  std::uint32_t sequence = 0;  ///< number of the frame, counted by the camera; 0 if unknown
  std::string damage;          ///< why the packet cannot be used; empty if it can
};

/// A recording of a Kinect v2: what is known of the camera, and the list of its depth packets.
struct Recording {
  std::filesystem::path folder;
  /// The infrared camera, for images whose columns are as the camera sends them (mirror.hpp).
  CameraModel camera;
  /// True if the recording has no intrinsics, so that `camera` is that of `typical_intrinsics`.
  bool camera_is_assumed = false;
  std::string serial;             ///< of the device; empty if unknown
  std::filesystem::path p0_file;  ///< the file of `p0`
  P0Tables p0;
  std::vector<RecordedPacket> packets;  ///< in the order in which they were recorded
  /// Number of frames that the camera counted between the first and the last packet, but for which
  /// there is neither a packet nor an unreadable entry.
  std::uint64_t never_recorded = 0;
  /// False if a recording directory has no recording.complete: the program that wrote it was
  /// interrupted.
  bool is_complete = true;
  /// Place of a last line of frames.ndjson that an interruption cut off, as "frames.ndjson:12".
  /// Empty if there is none. Such a line is no damage.
  std::string unfinished_line;
};

/// Opens a recording in one of two forms:
/// - a recording directory of version 1 or 2 with manifest.json, frames.ndjson (one line a frame)
///   and the files that they name. Color frames are passed over. An interrupted recording may lack
///   manifest.json, since programs write it last; then the camera is assumed.
/// - a directory of loose packets of the dump pipeline, PREFIX_TIMESTAMP_SEQUENCE.depth, in
///   the order of their timestamps, with P0 tables beside them in p0.bin, p0tables.dat or
///   calibration/p0.bin. They have no intrinsics.
///
/// If `p0_file` is not empty, it replaces the P0 tables of the recording.
///
/// A fault of one packet damages that packet only: a line of frames.ndjson that cannot be read, a
/// path that leads out of the recording or is named twice, a file that is missing or not of a
/// packet's size, a byte_count that is not a packet's size, or a timestamp or sequence number that
/// does not increase. Of packets in the wrong order, the one is damaged without which the others
/// are in order. Packets are not read.
///
/// Throws InputError, which names the file, the line or key, and the remedy, if the directory is
/// neither form, if manifest.json is not valid or of another version, if the intrinsics are those
/// of no camera, if the P0 tables are missing or not valid, or if there are no packets.
Recording open_recording(const std::filesystem::path& folder,
                         const std::filesystem::path& p0_file = {});

}  // namespace tofmap::kinect2

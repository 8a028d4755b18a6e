// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/option_table.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {

/// The beginning of every device URI.
inline constexpr const char* uri_scheme = "tofmap://";

/// How a device plays frames.
struct PlayerOptions {
  /// `stacked`: each image holds A above B, and a tag. `alternating`: the images of A and B
  /// alternate, without a tag.
  std::string layout = "stacked";
  /// What depth images hold. `radial`: range along the ray of each pixel. `z`: depth along the
  /// optical axis, OpenNI2's convention.
  std::string depth = "radial";
  /// Playback speed relative to that of the recording or scene, −1 … 1000. 0: as fast as possible.
  /// Negative: one frame whenever a client waits for one.
  double speed = 1;
  /// Number of times that the frames are played, 0 … 1e6. 0: for ever.
  int repeat = 1;
  /// Number of frames after which the device disappears as if unplugged, 0 … 1e9. 0: never.
  int unplug_at = 0;
  /// Drops every n-th image on the way to the client, 0 … 1e6. 0: drops none.
  int lose_every = 0;

  static std::vector<OptionField<PlayerOptions>> fields();
};

/// The device that a URI describes:
///
///     tofmap://SCENE?option=value&…              a simulated camera in a scene
///     tofmap:///path/to/sequence?option=value&…  a recording
///
/// The options are the fields of `player`, and the fields of `simulator` as `simulator.NAME=VALUE`.
struct DeviceRequest {
  std::string scene;  ///< name of a scene, or folder of a recording, which begins with a slash
  PlayerOptions player;
  SimulatorOptions simulator;

  bool is_recording() const { return scene.starts_with('/'); }
};

/// Parses a device URI. Throws UsageError if the URI has neither form, or if an option is unknown,
/// not allowed or given twice.
DeviceRequest parse_device_uri(const std::string& uri);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include <tofmap/acquisition/device_options.hpp>
#include <tofmap/core/named_value.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {

/// The beginning of every device URI.
inline constexpr const char* uri_scheme = "tofmap://";

/// How a device plays the images of A and B: ImageLayout without the value that leaves it to a tag.
enum class PlayedLayout {
  stacked,      ///< each image holds those of all frequencies, one below the other
  alternating,  ///< the images of the frequencies arrive in turn
};

std::span<const NamedValue<PlayedLayout>> named_values(PlayedLayout);

/// How a device plays frames.
struct PlayerOptions {
  /// How images of A and B are played. Only stacked images have a tag.
  PlayedLayout layout = PlayedLayout::stacked;
  /// What depth images hold.
  DepthKind depth = DepthKind::radial;
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

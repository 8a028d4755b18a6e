// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/option_table.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {

/// What every address of a device begins with.
inline constexpr const char* uri_scheme = "tofmap://";

/// How a device plays frames.
struct PlayerOptions {
  std::string layout = "stacked";
  std::string depth = "radial";
  double speed = 1;
  int repeat = 1;
  int unplug_at = 0;
  int lose_every = 0;

  static std::vector<OptionField<PlayerOptions>> fields();
};

/// What an address asks for:
///
///     tofmap://SCENE?option=value&…             a simulated camera in a scene
///     tofmap:///path/to/sequence?option=value…  a recorded one
///
/// Options are those of `player`, and as `simulator.NAME=VALUE` those of the simulator.
struct DeviceRequest {
  std::string scene;  ///< or the folder of a recording, which begins with a slash
  PlayerOptions player;
  SimulatorOptions simulator;

  bool is_recording() const { return scene.starts_with('/'); }
};

/// Throws UsageError if the address is none of the above or an option is not allowed.
DeviceRequest parse_device_uri(const std::string& uri);

}  // namespace tofmap

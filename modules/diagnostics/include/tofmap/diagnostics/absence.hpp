// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include <tofmap/core/named_value.hpp>

namespace tofmap {

/// Why a frame is in no map. The names are keys of report.json.
enum class Absence {
  damaged,          ///< it could not be read
  repeated,         ///< it repeats the frame before it
  without_range,    ///< no pixel has a range: the camera saw nothing
  without_surface,  ///< too few points have a normal
  unregistered,     ///< it could not be registered with the frames around it, and began no map
};
std::span<const NamedValue<Absence>> named_values(Absence);

/// The reason, to follow "frames" or their number: "without any range".
std::string_view told(Absence absence);

/// Numbers of frames that are in no map. Reasons without frames are left out.
using MissingFrames = std::map<Absence, int>;

/// The numbers with their reasons: "3 damaged, 20 without any range". Empty if no frame is missing.
std::string told(const MissingFrames& missing);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/absence.hpp"

#include <array>
#include <vector>

#include <fmt/format.h>

#include <tofmap/core/text.hpp>

namespace tofmap {

std::span<const NamedValue<Absence>> named_values(Absence) {
  static constexpr std::array<NamedValue<Absence>, 5> absences{
      {{"damaged", Absence::damaged},
       {"repeated", Absence::repeated},
       {"without_range", Absence::without_range},
       {"without_surface", Absence::without_surface},
       {"unregistered", Absence::unregistered}}};
  return absences;
}

std::string_view told(Absence absence) {
  switch (absence) {
    case Absence::damaged:
      return "damaged";
    case Absence::repeated:
      return "repeating the frame before";
    case Absence::without_range:
      return "without any range";
    case Absence::without_surface:
      return "with too little surface";
    case Absence::unregistered:
      return "not registered";
  }
  return {};
}

std::string told(const MissingFrames& missing) {
  std::vector<std::string> parts;
  for (const auto& [absence, count] : missing) {
    parts.push_back(fmt::format("{} {}", count, told(absence)));
  }
  return joined(parts, ", ");
}

}  // namespace tofmap

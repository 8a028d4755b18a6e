// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/refusal.hpp"

#include <fmt/format.h>

#include <tofmap/core/text.hpp>
#include <tofmap/mapping/map_join.hpp>

namespace tofmap::app {

namespace {

std::string told(int keyframes) { return counted(static_cast<std::size_t>(keyframes), "keyframe"); }

}  // namespace

std::string told_nearness(const MapNearness& nearness) {
  return fmt::format(
      "of {} that were compared, {} may see places of it, {} of which agree on one; {} must, "
      "without "
      "contradicting it{}",
      told(nearness.keyframes), nearness.recognised, nearness.agreeing, least_agreeing_keyframes,
      nearness.is_ambiguous ? ". Another place is as likely" : "");
}

std::string told_refusal(const MapNearness& nearness, std::size_t frames) {
  const std::string refused = fmt::format(
      "none of {} could be found in the map, which stays as it was: ", counted(frames, "frame"));
  if (nearness.keyframes == 0) {
    return refused +
           "too few of them could be registered with each other to compare them; 'tofmap "
           "map' of the recording by itself says why";
  }
  const std::string near = refused + told_nearness(nearness);
  if (nearness.is_ambiguous) return near + "; say where the camera begins with --start";
  return near +
         ". The recording shows another place, or the same from where the map was not seen from";
}

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/refusal.hpp"

#include <fmt/format.h>

#include <tofmap/core/text.hpp>
#include <tofmap/mapping/map_join.hpp>

namespace tofmap::app {

namespace {

std::string told(int keyframes) { return counted(static_cast<std::size_t>(keyframes), "keyframe"); }

std::string told(JoinObstacle obstacle) {
  switch (obstacle) {
    case JoinObstacle::none:
    case JoinObstacle::too_few:
      break;
    case JoinObstacle::contradicted:
      return ". They agree on one, but see through surfaces that are there";
    case JoinObstacle::ambiguous:
      return ". They fit to several places, to each nearly as well";
  }
  return "";
}

}  // namespace

std::string told_nearness(const MapNearness& nearness) {
  return fmt::format(
      "of {} that were compared, {} may see places of it, {} of which agree on one; {} must, "
      "without contradicting it{}",
      told(nearness.keyframes), nearness.recognised, nearness.agreeing, least_agreeing_keyframes,
      told(nearness.obstacle));
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
  if (nearness.obstacle == JoinObstacle::ambiguous) {
    return near + "; say where the camera begins with --start";
  }
  if (nearness.obstacle == JoinObstacle::contradicted) {
    return near + ". The recording shows another place that looks alike, or much was moved in it";
  }
  return near +
         ". The recording shows another place, or the same from where the map was not seen from";
}

}  // namespace tofmap::app

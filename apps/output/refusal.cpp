// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/refusal.hpp"

#include <algorithm>

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

std::string told_refusal(const MapNearness& nearness, std::span<const FrameRecord> frames,
                         bool has_start) {
  const std::string refused =
      fmt::format("none of {} could be found in the map, which stays as it was: ",
                  counted(frames.size(), "frame"));
  const auto is_registered = [](const FrameRecord& frame) { return frame.tracking.registered(); };
  if (std::ranges::none_of(frames, is_registered)) {
    return refused +
           "no frame has enough surface; is the camera covered, or are the phase images "
           "mislabelled? 'tofmap info' prints more about the recording";
  }
  if (nearness.keyframes == 0 && has_start) {
    return refused + "it shows nothing within reach of --start; correct that, or leave it out";
  }
  const std::string near = refused + told_nearness(nearness);
  if (nearness.keyframes < static_cast<int>(least_agreeing_keyframes)) {
    return near + ". The camera hardly moved; move it by half a metre, or turn it by 30 degrees";
  }
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

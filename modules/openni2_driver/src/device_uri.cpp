// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "device_uri.hpp"

#include <array>
#include <set>
#include <sstream>

#include <tofmap/core/error.hpp>

namespace tofmap {

std::span<const NamedValue<PlayedLayout>> named_values(PlayedLayout) {
  static constexpr std::array<NamedValue<PlayedLayout>, 2> layouts{
      {{"stacked", PlayedLayout::stacked}, {"alternating", PlayedLayout::alternating}}};
  return layouts;
}

std::vector<OptionField<PlayerOptions>> PlayerOptions::fields() {
  using P = PlayerOptions;
  return {
      {"layout", &P::layout, 0, 0, "",
       "stacked: each image holds those of all frequencies, and a tag; alternating: the images of "
       "the frequencies arrive in turn, without a tag"},
      {"depth", &P::depth, 0, 0, "",
       "what depth images hold; radial: range along each pixel's ray; z: depth along the optical "
       "axis, OpenNI2's convention"},
      {"speed", &P::speed, -1, 1000, "",
       "playback speed relative to the recording; 0: as fast as possible; -1: a frame whenever a "
       "client waits for one"},
      {"repeat", &P::repeat, 0, 1000000, "",
       "number of times that the frames are played; 0: for ever"},
      {"unplug_at", &P::unplug_at, 0, 1000000000, "",
       "number of frames after which the device disappears as if unplugged; 0: never"},
      {"lose_every", &P::lose_every, 0, 1000000, "", "drops every n-th image; 0: drops none"},
  };
}

DeviceRequest parse_device_uri(const std::string& uri) {
  if (!uri.starts_with(uri_scheme)) {
    throw UsageError("'" + uri + "' does not begin with " + uri_scheme);
  }
  const std::string address = uri.substr(std::string(uri_scheme).size());
  const std::size_t question = address.find('?');
  DeviceRequest request;
  request.scene = address.substr(0, question);
  if (request.scene.empty()) {
    throw UsageError("'" + uri + "' names neither a scene nor the folder of a recording");
  }
  if (question == std::string::npos) return request;
  OptionTable table;
  table.bind("", request.player);
  table.bind("simulator", request.simulator);
  std::istringstream assignments(address.substr(question + 1));
  std::set<std::string> names;
  for (std::string one; std::getline(assignments, one, '&');) {
    const std::size_t equals = one.find('=');
    if (equals == 0 || equals == std::string::npos) {
      throw UsageError("expected option=value, got '" + one + "'");
    }
    const std::string name = one.substr(0, equals);
    if (!names.insert(name).second) throw UsageError("option " + name + " is given twice");
    table.set(name, one.substr(equals + 1));
  }
  return request;
}

}  // namespace tofmap

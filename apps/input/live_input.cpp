// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/live_input.hpp"

#include "console/interruption.hpp"
#include "input/recording.hpp"

#include <array>
#include <sstream>

#include <nlohmann/json.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

OpenNi2Source::Settings camera_settings(const ProgramOptions& options,
                                        const LiveInput::Wanted& wanted) {
  return {.options = options.device,
          .calibration = calibration_of(options.camera),
          .oni_file = wanted.oni_file,
          .most_frames = wanted.most_frames,
          .keep_going = [] { return !is_interrupted(); }};
}

LateFrames policy(const LiveOptions& options, const OpenNi2Source& source) {
  const bool waits =
      options.late_frames == LateFramesOption::block ||
      (options.late_frames == LateFramesOption::by_source && source.waits_for_reader());
  return waits ? LateFrames::block : LateFrames::drop_oldest;
}

const char* end_name(OpenNi2Source::End end) {
  switch (end) {
    case OpenNi2Source::End::of_recording:
      return "end of the recording";
    case OpenNi2Source::End::unplugged:
      return "unplugged";
    case OpenNi2Source::End::timeout:
      return "no more images";
    case OpenNi2Source::End::none:  // the reader stopped
    case OpenNi2Source::End::asked:
      return "as asked";
  }
  return "";
}

}  // namespace

std::span<const NamedValue<LateFramesOption>> named_values(LateFramesOption) {
  static constexpr std::array<NamedValue<LateFramesOption>, 3> values{
      {{"auto", LateFramesOption::by_source},
       {"drop", LateFramesOption::drop},
       {"block", LateFramesOption::block}}};
  return values;
}

std::vector<OptionField<LiveOptions>> LiveOptions::fields() {
  return {
      {"queue", &LiveOptions::queue, 1, 10000, "",
       "number of frames that may wait to be processed"},
      {"late_frames", &LiveOptions::late_frames, 0, 0, "",
       "what to do with a new frame when the queue is full. drop: drop the oldest frame; block: "
       "make the device wait; auto: block if the source waits for its reader, as files do, else "
       "drop"},
  };
}

LiveInput::LiveInput(const std::string& uri, const ProgramOptions& options, const Wanted& wanted)
    : uri_(uri),
      timeout_s_(options.device.timeout_s),
      source_(uri, camera_settings(options, wanted)),
      queue_(source_, options.live.queue, policy(options.live, source_)),
      watched_(queue_, options.pipeline.unwrap) {}

std::string LiveInput::losses() const {
  const PairingCounts counts = source_.counts();
  std::string text;
  const auto add = [&](int count, const char* what) {
    if (count == 0) return;
    text += (text.empty() ? "" : ", ") + counted(static_cast<std::size_t>(count), what);
  };
  add(queue_.dropped(), "late frame");
  add(counts.dropped(), "unpaired image");
  add(counts.lost, "lost image");
  return text;
}

nlohmann::ordered_json LiveInput::report() {
  const PairingCounts counts = source_.counts();
  return {{"uri", uri_},
          {"end", end_name(source_.end())},
          {"frames_dropped_late", queue_.dropped()},
          {"images",
           {{"paired", counts.paired},
            {"half_missing", counts.half_missing},
            {"duplicates", counts.duplicates},
            {"out_of_order", counts.out_of_order},
            {"unreadable", counts.unreadable},
            {"undecided", counts.undecided},
            {"lost", counts.lost}}}};
}

std::string LiveInput::silence() const {
  if (source_.end() != OpenNi2Source::End::timeout) return "";
  std::ostringstream text;
  text << uri_ << ": no image for " << timeout_s_
       << " s (device.timeout_s); the frames before that are kept";
  return text.str();
}

}  // namespace tofmap::app

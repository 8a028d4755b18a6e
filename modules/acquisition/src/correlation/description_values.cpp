// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "description_section.hpp"

#include <cmath>

namespace tofmap {
namespace {

/// A table of companding has at most so many bits: 65536 entries.
constexpr int most_companded_bits = 16;

std::vector<float> read_companding(const YamlSection& section, int bits) {
  section.allow_only({"table", "segments", "negative_from"});
  const int codes = 1 << bits;
  if (section.has("table") == section.has("segments")) {
    section.fail(section.key("table"), "or segments must be given, and not both");
  }
  if (section.has("table")) {
    const auto table = section.value<std::vector<double>>("table", "a list of numbers");
    if (table.empty() || table.size() > static_cast<std::size_t>(codes)) {
      section.fail(section.key("table"), "has " + std::to_string(table.size()) +
                                             " entries; allowed: 1 to " + std::to_string(codes) +
                                             ", as values.bits says");
    }
    return {table.begin(), table.end()};
  }
  std::vector<CompandingSegment> segments;
  for (const YamlSection& segment : section.list("segments")) {
    segment.allow_only({"code", "value", "step"});
    segments.push_back({segment.value<int>("code", "a code"),
                        segment.value<double>("value", "a number"),
                        segment.value<double>("step", "a number")});
    const bool ascends = segments.size() == 1
                             ? segments[0].code == 0
                             : segments.back().code > segments[segments.size() - 2].code;
    if (!ascends || segments.back().code >= codes) {
      segment.fail(segment.key("code"),
                   "must be 0 in the first segment, ascend, and be below " + std::to_string(codes));
    }
  }
  if (segments.empty()) section.fail(section.key("segments"), "is empty");
  int negative_from = 0;
  if (section.has("negative_from")) {
    negative_from = section.value<int>("negative_from", "a code");
    if (2 * negative_from < codes || negative_from >= codes) {
      section.fail(section.key("negative_from"),
                   "must be " + std::to_string(codes / 2) + " to " + std::to_string(codes - 1));
    }
  }
  return companding_table(segments, codes, negative_from);
}

void read_saturation(const YamlSection& section, StepValues& values) {
  section.allow_only({"codes", "from", "up_to"});
  if (section.has("codes")) {
    values.saturated_codes =
        section.value<std::vector<std::int64_t>>("codes", "a list of whole numbers");
  }
  if (section.has("from")) values.saturated_from = section.value<double>("from", "a number");
  if (section.has("up_to")) values.saturated_up_to = section.value<double>("up_to", "a number");
  if (values.saturated_up_to >= values.saturated_from) {
    section.fail(section.key("up_to"), "must be less than 'from'");
  }
}

}  // namespace

StepValues read_step_values(const YamlSection& section) {
  section.allow_only({"bits", "shift", "signed", "companding", "saturation"});
  StepValues values;
  if (section.has("bits")) {
    values.bits = section.value<int>("bits", "a number of bits");
    if (values.bits < 1 || values.bits > 64) {
      section.fail(section.key("bits"), "must be 1 to 64, not " + std::to_string(values.bits));
    }
  }
  if (section.has("shift")) {
    values.shift = section.value<int>("shift", "a number of bits");
    if (values.shift < 0 || values.shift > 63) {
      section.fail(section.key("shift"), "must be 0 to 63, not " + std::to_string(values.shift));
    }
  }
  if (section.has("signed")) values.is_signed = section.value<bool>("signed", "true or false");
  if (section.has("companding")) {
    if (values.bits < 1 || values.bits > most_companded_bits) {
      section.fail(section.key("bits"), "must be given with companding, and be at most " +
                                            std::to_string(most_companded_bits));
    }
    if (values.is_signed) {
      section.fail(section.key("signed"), "cannot be given with companding, which tells the sign");
    }
    values.is_signed = false;
    values.companding = read_companding(section.section("companding"), values.bits);
  }
  if (section.has("saturation")) read_saturation(section.section("saturation"), values);
  return values;
}

FrameTimes read_frame_times(const YamlSection& section, const std::filesystem::path& folder) {
  section.allow_only({"rate_hz", "start_s", "times_s", "file", "column", "unit"});
  FrameTimes times;
  const int ways = section.has("rate_hz") + section.has("times_s") + section.has("file");
  if (ways != 1) {
    section.fail(section.key("rate_hz"), "or times_s or file must be given, exactly one of them");
  }
  if (section.has("rate_hz")) {
    times.rate_hz = section.value<double>("rate_hz", "a number of frames a second");
    if (!(times.rate_hz > 0)) section.fail(section.key("rate_hz"), "must be above 0");
  }
  if (section.has("start_s")) times.start_s = section.value<double>("start_s", "a time in seconds");
  if (section.has("times_s")) {
    times.times_s = section.value<std::vector<double>>("times_s", "a list of times in seconds");
  }
  if (section.has("file")) {
    times.file = folder / section.value<std::string>("file", "the name of a text file");
  }
  if (!section.has("file") && (section.has("column") || section.has("unit"))) {
    section.fail(section.key("column and unit"), "are for a file of timestamps");
  }
  if (section.has("column")) {
    times.column = section.value<int>("column", "the number of a column, counted from 0");
    if (times.column < 0) section.fail(section.key("column"), "must be 0 or more");
  }
  if (section.has("unit")) {
    times.unit_s =
        word_of<double>(section, "unit", {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}});
  }
  return times;
}

}  // namespace tofmap

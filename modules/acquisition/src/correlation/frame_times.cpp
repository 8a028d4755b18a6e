// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "frame_times.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <string>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

double time_in(const std::vector<std::string>& words, int column, const std::string& place) {
  const auto index = static_cast<std::size_t>(column);
  if (index >= words.size()) {
    throw InputError(place + ": has " + counted(words.size(), "column") +
                     ", but timestamps are in " + "column " + std::to_string(column) +
                     ", counted from 0");
  }
  const std::string& word = words[index];
  double time = 0;
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), time);
  if (error != std::errc() || rest != word.data() + word.size() || !std::isfinite(time)) {
    throw InputError(place + ": the timestamp '" + word + "' is not a number");
  }
  return time;
}

std::vector<double> read_times(const FrameTimes& times) {
  refuse_no_file(times.file);
  std::ifstream in(times.file);
  if (!in) throw InputError(times.file.string() + ": cannot be read; it must hold timestamps");
  std::vector<double> times_s;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::vector<std::string> words = words_of_line(line);
    if (words.empty() || words.front().starts_with('#')) continue;
    const std::string place = times.file.string() + ":" + std::to_string(number);
    times_s.push_back(times.unit_s * time_in(words, times.column, place));
  }
  if (times_s.empty()) throw InputError(times.file.string() + ": holds no timestamps");
  return times_s;
}

}  // namespace

std::vector<double> listed_times_s(const FrameTimes& times, const std::filesystem::path& origin) {
  const bool in_file = !times.file.empty();
  std::vector<double> times_s = in_file ? read_times(times) : times.times_s;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    times_s[i] += times.start_s;
    if (i == 0 || times_s[i] > times_s[i - 1]) continue;
    throw InputError((in_file ? times.file : origin).string() + ": timestamp number " +
                     std::to_string(i + 1) + ", " + std::to_string(times_s[i]) +
                     " s, is not later than the one before it");
  }
  return times_s;
}

double regular_time_s(const FrameTimes& times, std::int64_t number) {
  const double rate_hz = times.rate_hz > 0 ? times.rate_hz : 1;
  return times.start_s + static_cast<double>(number) / rate_hz;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "inner_path.hpp"
#include "sequence_header.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string_view>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

constexpr std::uint16_t no_return = 65535;

/// The columns of a line, for messages: "timestamp phase_a phase_b [amplitude_a amplitude_b]".
std::string columns(std::size_t frequencies) {
  std::string phases;
  std::string amplitudes;
  for (std::size_t f = 0; f < frequencies; ++f) {
    phases += std::string(" phase_") + frequency_letter(f);
    amplitudes += std::string(f == 0 ? "" : " ") + "amplitude_" + frequency_letter(f);
  }
  return "timestamp" + phases + " [" + amplitudes + "]";
}

double parse_time(const std::string& word, const std::string& place) {
  double time_s = 0;
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, time_s);
  if (error != std::errc() || rest != end || !std::isfinite(time_s)) {
    throw InputError(place + ": the timestamp '" + word + "' is not a number of seconds");
  }
  return time_s;
}

SequenceFrameFiles parse_line(const std::vector<std::string>& words, std::size_t frequencies,
                              const std::string& place) {
  const std::string expected = ": expected '" + columns(frequencies) + "'";
  if (words.size() < 1 + frequencies || words.size() > 1 + 2 * frequencies) {
    throw InputError(place + expected + ", got " + counted(words.size(), "column"));
  }
  SequenceFrameFiles files;
  files.timestamp_s = parse_time(words[0], place);
  const auto phases = words.begin() + 1;
  const auto amplitudes = phases + static_cast<std::ptrdiff_t>(frequencies);
  if (std::find(phases, amplitudes, "-") != amplitudes) {
    throw InputError(place + expected + "; only an amplitude may be '-'");
  }
  for (auto word = phases; word != words.end(); ++word) {
    if (*word == "-" || std::find(phases, word, *word) == word) continue;
    throw InputError(place + ": names '" + *word + "' twice; every image has a file of its own");
  }
  for (auto word = phases; word != words.end(); ++word) {
    if (*word == "-") continue;
    (word < amplitudes ? files.phases : files.amplitudes).push_back(naming(place, [&] {
      return inner_path(*word, "sequence");
    }));
  }
  if (files.amplitudes.size() < frequencies) files.amplitudes.clear();
  return files;
}

/// Marks frames with a wrong timestamp as damaged. Of two lines in the wrong order, the second one
/// is marked, unless it is in order with the lines before and after the pair: then the first one is
/// marked, as when a single timestamp is far ahead of all others.
void mark_times_out_of_order(std::vector<SequenceFrameFiles>& frames,
                             const std::filesystem::path& file) {
  std::vector<SequenceFrameFiles*> whole;
  for (SequenceFrameFiles& frame : frames) {
    if (frame.damage.empty()) whole.push_back(&frame);
  }
  const auto time_s = [&](std::size_t i) { return whole[i]->timestamp_s; };
  const auto mark = [&](SequenceFrameFiles& frame, const char* relation, double other_s) {
    std::ostringstream text;
    text << std::setprecision(16) << file.string() << ": the timestamp " << frame.timestamp_s
         << " of " << frame.phases.front().string() << " is not " << relation << ' ' << other_s;
    frame.damage = text.str();
  };
  double latest_s = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const bool is_ahead = i + 2 < whole.size() && time_s(i + 1) > latest_s &&
                          time_s(i + 2) > time_s(i + 1) && time_s(i) >= time_s(i + 2);
    if (time_s(i) <= latest_s) {
      mark(*whole[i], "later than the one before it,", latest_s);
    } else if (is_ahead) {
      mark(*whole[i], "earlier than the one after it,", time_s(i + 1));
    } else {
      latest_s = time_s(i);
    }
  }
}

/// Throws InputError if more than half of the lines are damaged.
void refuse_mostly_damaged(const std::vector<SequenceFrameFiles>& frames) {
  const auto is_damaged = [](const SequenceFrameFiles& frame) { return !frame.damage.empty(); };
  const auto damaged = static_cast<std::size_t>(std::ranges::count_if(frames, is_damaged));
  if (2 * damaged <= frames.size()) return;
  const std::string& first = std::ranges::find_if(frames, is_damaged)->damage;
  throw InputError(frames.size() == 1 ? first
                                      : first + " (" + std::to_string(damaged) + " of " +
                                            std::to_string(frames.size()) + " lines are damaged)");
}

/// Gives each damaged line the timestamp of the nearest valid line before it or, at the beginning
/// of the list, of the first valid line.
void fill_times(std::vector<SequenceFrameFiles>& frames) {
  const auto is_whole = [](const SequenceFrameFiles& frame) { return frame.damage.empty(); };
  double time_s = std::ranges::find_if(frames, is_whole)->timestamp_s;
  for (SequenceFrameFiles& frame : frames) {
    if (is_whole(frame)) {
      time_s = frame.timestamp_s;
    } else {
      frame.timestamp_s = time_s;
    }
  }
}

std::vector<SequenceFrameFiles> read_frame_list(const std::filesystem::path& file,
                                                std::size_t frequencies) {
  refuse_no_file(file);
  std::ifstream in(file);
  if (!in) {
    throw InputError(file.string() +
                     ": cannot be read; a sequence folder holds sequence.yaml and frames.txt");
  }
  std::vector<SequenceFrameFiles> frames;
  std::string line;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  for (int number = 1; std::getline(in, line); ++number) {
    if (number == 1 && line.starts_with(byte_order_mark)) line.erase(0, byte_order_mark.size());
    const std::vector<std::string> words = words_of_line(line);
    if (words.empty() || words.front().starts_with('#')) continue;
    try {
      frames.push_back(
          parse_line(words, frequencies, file.string() + ":" + std::to_string(number)));
    } catch (const InputError& error) {
      SequenceFrameFiles damaged;
      damaged.damage = error.what();
      frames.push_back(std::move(damaged));
    }
  }
  if (in.bad()) throw InputError(file.string() + ": cannot be read to its end");
  if (frames.empty()) throw InputError(file.string() + ": lists no frames; record at least one");
  refuse_mostly_damaged(frames);
  fill_times(frames);
  mark_times_out_of_order(frames, file);
  return frames;
}

ImageU16 read_sized(const std::filesystem::path& file, const CameraModel& camera) {
  ImageU16 image = read_png_16(file);
  if (image.cols() != camera.width_px || image.rows() != camera.height_px) {
    throw InputError(file.string() + ": is " + std::to_string(image.cols()) + " x " +
                     std::to_string(image.rows()) + " pixels, but the camera of sequence.yaml " +
                     "has a width of " + std::to_string(camera.width_px) + " and a height of " +
                     std::to_string(camera.height_px));
  }
  return image;
}

ImageF phase_from_pixels(const ImageU16& pixels) {
  return (pixels == no_return).select(nan, pixels.cast<float>() / 65535.0F);
}

}  // namespace

SequenceReader::SequenceReader(std::filesystem::path folder, CameraCalibration calibration)
    : folder_(std::move(folder)), calibration_(std::move(calibration)) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder_, ignored)) {
    const bool is_file = std::filesystem::exists(folder_, ignored);
    throw InputError(folder_.string() +
                     (is_file ? ": is a file; give its folder, with "
                              : ": no such folder; a sequence is a folder with ") +
                     "sequence.yaml in it");
  }
  sensor_ = read_sequence_header(folder_ / "sequence.yaml");
  constexpr double end_of_scale = 65535;  // the true amplitude may have been larger
  sensor_.saturation_amplitude = end_of_scale;
  sensor_ = calibrated(sensor_, calibration_);
  files_ = read_frame_list(folder_ / "frames.txt", sensor_.modulation.count());
}

void SequenceReader::start_at(int index) { next_index_ = index; }

std::optional<SourcedFrame> SequenceReader::next() {
  if (next_index_ >= static_cast<int>(files_.size())) return std::nullopt;
  return read(next_index_++);
}

const SequenceFrameFiles& SequenceReader::files_at(int index) const {
  if (index < 0 || index >= static_cast<int>(files_.size())) {
    throw UsageError("frame " + std::to_string(index) + " of " + folder_.string() +
                     ": the frames are 0 to " + std::to_string(files_.size() - 1));
  }
  return files_[static_cast<std::size_t>(index)];
}

SourcedFrame SequenceReader::read(int index) const {
  const SequenceFrameFiles& files = files_at(index);
  SourcedFrame sourced;
  sourced.index = index;
  sourced.timestamp_s = files.timestamp_s;
  sourced.damage = files.damage;
  if (!files.damage.empty()) return sourced;
  try {
    sourced.frame = read_frame(index);
  } catch (const InputError& error) {
    sourced.damage = error.what();
  }
  return sourced;
}

Frame SequenceReader::read_frame(int index) const {
  const SequenceFrameFiles& files = files_at(index);
  Frame frame;
  frame.index = index;
  frame.timestamp_s = files.timestamp_s;
  for (const std::filesystem::path& file : files.phases) {
    frame.phases.push_back(phase_from_pixels(read_sized(folder_ / file, sensor_.camera)));
  }
  calibrate(frame, sensor_.modulation, calibration_);
  for (std::size_t f = 0; f < files.amplitudes.size(); ++f) {
    frame.amplitudes.push_back(
        read_sized(folder_ / files.amplitudes[f], sensor_.camera).cast<float>());
    frame.phases[f] = (frame.amplitudes[f] == 0).select(nan, frame.phases[f]);
  }
  return frame;
}

Trajectory SequenceReader::ground_truth() const {
  const std::filesystem::path file = folder_ / "groundtruth.txt";
  std::error_code unknown;
  const bool is_missing = !std::filesystem::exists(file, unknown) && !unknown;
  return is_missing ? Trajectory{} : read_trajectory(file);
}

std::optional<ImageF> SequenceReader::range_truth(int index) const {
  const SequenceFrameFiles& files = files_at(index);
  if (files.phases.empty()) return std::nullopt;
  const std::filesystem::path name = files.phases.front().filename();
  const std::filesystem::path file = folder_ / "range_truth" / name;
  std::error_code unknown;
  const bool is_missing = !std::filesystem::exists(file, unknown) && !unknown;
  if (is_missing) return std::nullopt;
  const ImageU16 range_mm = read_sized(file, sensor_.camera);
  return (range_mm == 0).select(nan, range_mm.cast<float>() / 1000.0F);
}

}  // namespace tofmap

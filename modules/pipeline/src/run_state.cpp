// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/pipeline/run_state.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

// Raise the number after the comma whenever the stored data change between two releases.
constexpr const char* first_line = "tofmap map state " TOFMAP_VERSION ", 23";

/// The camera, frequencies and options of a run, one per line. A run can only resume a run with the
/// same lines.
std::vector<std::string> identity(const SensorModel& sensor, PipelineOptions options) {
  std::ostringstream text;
  text.precision(17);
  const CameraModel& camera = sensor.camera;
  text << "camera: " << camera.width_px << " x " << camera.height_px << " px, " << camera.fx_px
       << ' ' << camera.fy_px << ' ' << camera.cx_px << ' ' << camera.cy_px << ", distortion";
  for (const double coefficient : camera.distortion) text << ' ' << coefficient;
  text << '\n' << "frequencies:";
  for (const double frequency_hz : sensor.modulation.frequencies_hz) text << ' ' << frequency_hz;
  text << " Hz, exposed at";
  for (const double offset_s : sensor.modulation.exposure_offsets_s) text << ' ' << offset_s;
  text << " s\n"
       << "largest range: " << sensor.max_range_m
       << " m, saturation: " << sensor.saturation_amplitude << '\n';
  OptionTable table;
  bind_options(table, options);
  text << table.to_yaml(false);
  std::vector<std::string> lines;
  std::istringstream in(text.str());
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Reads the lines of identity() from a state file. Throws UsageError, which quotes the first
/// difference, if they differ from `now`.
void check_identity(std::istream& in, const std::vector<std::string>& now,
                    const std::filesystem::path& folder) {
  std::string there;
  for (const std::string& line : now) {
    if (std::getline(in, there) && there == line) continue;
    throw UsageError(fmt::format(
        "{}: the interrupted run has '{}', this run has '{}'; give the same recording and options, "
        "or start anew without --resume",
        folder.string(), there, line));
  }
}

/// A line that identifies the first `frames` frames of a recording: their number, and a checksum of
/// their timestamps and of A's phases in the first and the last of them.
std::string recording_line(const SequenceReader& source, int frames) {
  boost::crc_32_type checksum;
  for (int i = 0; i < frames; ++i) {
    const double time_s = source.files()[static_cast<std::size_t>(i)].timestamp_s;
    checksum.process_bytes(&time_s, sizeof time_s);
  }
  for (const int i : {0, frames - 1}) {
    if (frames == 0) break;
    const SourcedFrame sourced = source.read(i);
    if (!sourced.frame) continue;
    const ImageF& phase = sourced.frame->phases[0];
    checksum.process_bytes(phase.data(), static_cast<std::size_t>(phase.size()) * sizeof(float));
  }
  return "recording: " + std::to_string(frames) + " frames, " + std::to_string(checksum.checksum());
}

/// Throws InputError unless `line` is the recording_line() of the frames of `source`.
void check_recording(const std::string& line, const SequenceReader& source,
                     const std::filesystem::path& folder) {
  int frames = -1;
  std::sscanf(line.c_str(), "recording: %d", &frames);
  const bool has_them = frames >= 0 && frames <= *source.frame_count();
  if (has_them && line == recording_line(source, frames)) return;
  throw InputError(folder.string() +
                   ": the interrupted run is of another recording; give that recording, or start "
                   "anew without --resume");
}

std::string checksum_line(std::string_view text) {
  boost::crc_32_type checksum;
  checksum.process_bytes(text.data(), text.size());
  return "\nchecksum: " + std::to_string(checksum.checksum());
}

/// Reads a state file and returns its text without the checksum line. Throws InputError if the
/// checksum is missing or wrong.
std::string read_checked(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::size_t end = text.rfind("\nchecksum: ");
  const bool is_whole = end != std::string::npos &&
                        text.compare(end, std::string::npos,
                                     checksum_line(std::string_view(text).substr(0, end))) == 0;
  if (!is_whole) throw InputError(file.string() + ": is damaged; start anew without --resume");
  text.resize(end);
  return text;
}

}  // namespace

std::string run_state(const MapRun& run, const FrameSample& sample, const SequenceReader& source,
                      PipelineOptions options) {
  std::ostringstream state;
  state << first_line << '\n';
  for (const std::string& line : identity(source.sensor(), std::move(options))) {
    state << line << '\n';
  }
  state << recording_line(source, static_cast<int>(run.frames().size())) << '\n';
  run.save(state);
  sample.save(state);
  std::string text = std::move(state).str();
  text += checksum_line(text);
  return text;
}

void resume_run(const std::filesystem::path& folder, MapRun& run, FrameSample& sample,
                SequenceReader& source, PipelineOptions options) {
  if (!std::filesystem::exists(folder)) return;
  const std::filesystem::path file = folder / run_state_file;
  if (!std::filesystem::is_regular_file(file)) {
    throw InputError(
        folder.string() +
        ": holds no interrupted run that could be resumed; start anew without --resume");
  }
  std::istringstream in(read_checked(file));
  std::string line;
  if (!std::getline(in, line) || line != first_line) {
    throw InputError(file.string() +
                     ": was written by another version of tofmap; start anew without --resume");
  }
  check_identity(in, identity(source.sensor(), std::move(options)), folder);
  std::getline(in, line);
  check_recording(line, source, folder);
  try {
    run.load(in);
    sample.load(in, static_cast<int>(run.frames().size()));
  } catch (const std::exception&) {
    throw InputError(file.string() +
                     ": was written by another build of tofmap; start anew without --resume");
  }
  source.start_at(static_cast<int>(run.frames().size()));
}

}  // namespace tofmap

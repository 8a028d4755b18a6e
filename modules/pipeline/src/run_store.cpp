// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/pipeline/run_store.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string>
#include <utility>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

// Raise the number whenever the stored state of a run changes between two releases. The map itself
// has a version of its own.
constexpr const char* state_version = TOFMAP_VERSION ", 30";

// The names of what is stored besides the map.
constexpr const char* version_entry = "run/version";
constexpr const char* identity_entry = "run/identity";
constexpr const char* recording_entry = "run/recording";
constexpr const char* all_entries = "run/";

/// The camera, frequencies and options of a run, one per line. A run can only resume a run with the
/// same lines.
std::string identity(const SensorModel& sensor, PipelineOptions options) {
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
  return text.str();
}

/// Throws UsageError, which quotes the first difference, if a run has another identity() than the
/// interrupted one.
void check_identity(const std::string& interrupted, const std::string& resuming) {
  std::istringstream there(interrupted);
  std::istringstream now(resuming);
  std::string line_there;
  for (std::string line; std::getline(now, line);) {
    if (std::getline(there, line_there) && line_there == line) continue;
    throw UsageError(fmt::format(
        "the interrupted run has '{}', this run has '{}'; give the same recording and options, or "
        "start anew without --resume",
        line_there, line));
  }
}

/// A line that identifies the first `frames` frames of a recording: their number, and a checksum of
/// their timestamps and of the first phases in the first and the last of them.
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
  return std::to_string(frames) + " frames, " + std::to_string(checksum.checksum());
}

/// Throws InputError unless `line` is the recording_line() of the frames of `source`.
void check_recording(const std::string& line, const SequenceReader& source) {
  int frames = -1;
  std::sscanf(line.c_str(), "%d", &frames);
  const bool has_them = frames >= 0 && frames <= *source.frame_count();
  if (has_them && line == recording_line(source, frames)) return;
  throw InputError(
      "the interrupted run is of another recording; give that recording, or start anew without "
      "--resume");
}

/// Throws InputError unless a stored frame has a phase image of each frequency.
void check_phases(const SampledFrame& frame, const SensorModel& sensor) {
  const auto is_there = [](const ImageF& phase) { return phase.size() > 0; };
  for (const Frame* one : {&frame.recorded, &frame.returns}) {
    if (one->phases.size() != sensor.modulation.count() ||
        !std::ranges::all_of(one->phases, is_there)) {
      throw InputError("a frame lacks the phases of a frequency");
    }
  }
}

}  // namespace

void store_run(MapStore& store, MapRun& run, FrameSample& sample, const SequenceReader& source,
               const PipelineOptions& options) {
  MapStore::Commit commit(store);
  commit.put(version_entry, state_version);
  commit.put(identity_entry, identity(source.sensor(), options));
  commit.put(recording_entry, recording_line(source, static_cast<int>(run.frames().size())));
  run.save(commit);
  sample.save(commit);
  commit.finish();
  run.note_saved();
  sample.note_saved(store);
}

void store_map(MapStore& store, MapRun& run) {
  MapStore::Commit commit(store);
  run.save_map(commit);
  commit.finish();
  run.note_saved();
}

void complete_map(MapStore& store, MapRun& run) {
  {
    MapStore::Commit commit(store);
    run.save_map(commit);
    commit.remove(all_entries);
    commit.finish();
  }
  run.note_saved();
  try {
    store.shrink();
  } catch (const InputError&) {
    // The map is whole. Its file is only larger than it could be.
  }
}

bool holds_run(const MapStore& store) { return store.entry(version_entry).has_value(); }

void resume_run(const MapStore& store, MapRun& run, FrameSample& sample, SequenceReader& source,
                const PipelineOptions& options) {
  const auto version = store.entry(version_entry);
  if (!version) {
    throw InputError("holds no interrupted run that could be resumed; start anew without --resume");
  }
  if (*version != state_version) {
    throw InputError("was written by another version of tofmap; start anew without --resume");
  }
  check_identity(store.expected_entry(identity_entry), identity(source.sensor(), options));
  check_recording(store.expected_entry(recording_entry), source);
  naming("the state of the run is damaged; start anew without --resume", [&] {
    run.load(store, [&](int index) { return source.read(index); });
    sample.load(store, static_cast<int>(run.frames().size()));
    for (const SampledFrame& frame : sample.frames()) check_phases(frame, source.sensor());
  });
  source.start_at(static_cast<int>(run.frames().size()));
}

}  // namespace tofmap

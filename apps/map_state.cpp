// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "map_state.hpp"

#include <fstream>
#include <sstream>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace {

constexpr const char* file_name = "state.bin";
constexpr const char* first_line = "tofmap map state " TOFMAP_VERSION;
constexpr const char* last_line = "data";

/// What a run must have in common with the one it goes on from, a fact a line.
std::vector<std::string> identity(const SensorModel& sensor, PipelineOptions options) {
  std::ostringstream text;
  text.precision(17);
  const CameraModel& camera = sensor.camera;
  text << "camera: " << camera.width_px << " x " << camera.height_px << " px, " << camera.fx_px
       << ' ' << camera.fy_px << ' ' << camera.cx_px << ' ' << camera.cy_px << '\n'
       << "frequencies: " << sensor.modulation.frequency_a_hz << ' '
       << sensor.modulation.frequency_b_hz << " Hz\n";
  OptionTable table;
  bind_options(table, options);
  text << table.to_yaml(false);
  std::vector<std::string> lines;
  std::istringstream in(text.str());
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

void check_identity(std::istream& in, const std::vector<std::string>& now,
                    const std::filesystem::path& folder) {
  std::string there;
  for (const std::string& line : now) {
    if (std::getline(in, there) && there == line) continue;
    throw UsageError(folder.string() + ": its run has '" + there + "', this one '" + line +
                     "'; give the same recording and options, or start anew without --resume");
  }
}

void check_recording(const MapRun& run, const SequenceReader& source,
                     const std::filesystem::path& folder) {
  const auto& files = source.files();
  bool is_same = run.frames().size() <= files.size();
  for (std::size_t i = 0; is_same && i < run.frames().size(); ++i) {
    is_same = run.frames()[i].timestamp_s == files[i].timestamp_s;
  }
  if (is_same) return;
  throw InputError(folder.string() +
                   ": its run is of another recording; give that one, or start anew without "
                   "--resume");
}

}  // namespace

void write_map_state(const std::filesystem::path& folder, const MapRun& run,
                     const SensorModel& sensor, PipelineOptions options) {
  const std::filesystem::path file = folder / file_name;
  std::ofstream out(file, std::ios::binary);
  out << first_line << '\n';
  for (const std::string& line : identity(sensor, std::move(options))) out << line << '\n';
  out << last_line << '\n';
  try {
    run.save(out);
  } catch (const std::exception&) {
    out.setstate(std::ios::failbit);
  }
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written; is the disk full?");
}

void take_up_map(const std::filesystem::path& folder, MapRun& run, SequenceReader& source,
                 PipelineOptions options) {
  if (!std::filesystem::exists(folder)) return;
  const std::filesystem::path file = folder / file_name;
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw InputError(folder.string() +
                     ": holds no interrupted run to go on with; start anew without --resume");
  }
  std::string line;
  if (!std::getline(in, line) || line != first_line) {
    throw InputError(file.string() +
                     ": was written by another version; start anew without --resume");
  }
  check_identity(in, identity(source.sensor(), std::move(options)), folder);
  try {
    std::getline(in, line);
    run.load(in);
  } catch (const std::exception&) {
    throw InputError(file.string() + ": is damaged; start anew without --resume");
  }
  check_recording(run, source, folder);
  source.start_at(static_cast<int>(run.frames().size()));
}

}  // namespace tofmap::app

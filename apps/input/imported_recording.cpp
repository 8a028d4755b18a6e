// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/imported_recording.hpp"

#include <array>
#include <cstdio>
#include <system_error>

#include <fmt/format.h>

#include <tofmap/acquisition/correlation/correlation_source.hpp>
#include <tofmap/acquisition/kinect2/kinect2_source.hpp>
#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code unknown;
  return fs::exists(path, unknown);
}

bool is_folder(const fs::path& path) {
  std::error_code unknown;
  return fs::is_directory(path, unknown);
}

/// Throws InputError if a path is a sequence: its folder or its sequence.yaml.
void refuse_sequence(const fs::path& path) {
  const fs::path header = is_folder(path) ? path / "sequence.yaml" : path;
  if (header.filename() != "sequence.yaml" || !is_there(header)) return;
  throw InputError(path.string() +
                   ": is a sequence already, which all commands read; there is nothing to import");
}

std::vector<std::string> warnings_about(const kinect2::Recording& recording) {
  std::vector<std::string> warnings;
  if (recording.camera_is_assumed) {
    warnings.emplace_back(
        "the recording has no intrinsics, and those of a typical Kinect v2 are assumed; write "
        "those of this camera into sequence.yaml, as docs/import-kinect2.md says");
  }
  if (!recording.is_complete) {
    const std::string& line = recording.unfinished_line;
    warnings.push_back("the recording was interrupted, as recording.complete is missing" +
                       (line.empty() ? "" : "; its last line, " + line + ", is cut off"));
  }
  if (recording.never_recorded > 0) {
    warnings.push_back(
        counted(recording.never_recorded, "frame") +
        " that the camera counted between the first and the last one were never recorded; a "
        "faster disk or computer loses fewer");
  }
  return warnings;
}

ImportedRecording open_kinect2(const ImportInput& input) {
  if (input.keep_inconsistent) {
    throw UsageError(
        "--keep-inconsistent belongs to 'tofmap import correlation'; the three steps of a Kinect "
        "v2 cannot tell inconsistent pixels");
  }
  refuse_sequence(input.path);
  auto source = std::make_unique<Kinect2Source>(kinect2::open_recording(input.path, input.p0));
  std::vector<std::string> warnings = warnings_about(source->recording());
  return {std::move(source), {}, {}, std::move(warnings), ImportedTruth(input.path)};
}

ImportedRecording open_correlation(const ImportInput& input) {
  if (!input.p0.empty()) {
    throw UsageError(
        "--p0 belongs to 'tofmap import kinect2'; a description has phase_offsets instead");
  }
  refuse_sequence(input.path);
  if (is_folder(input.path)) {
    throw InputError(input.path.string() +
                     ": is a folder; give the YAML file that describes the correlation images, or "
                     "import packets of a Kinect v2 by 'tofmap import kinect2'");
  }
  auto source = std::make_unique<CorrelationSource>(
      CorrelationReader(read_correlation_description(input.path)), input.keep_inconsistent);
  const CorrelationSource* counts = source.get();
  return {std::move(source),
          [counts] { return counts->inconsistent_pixels(); },
          [counts] { return counts->relative_residuals(); },
          {},
          ImportedTruth()};
}

}  // namespace

std::span<const NamedValue<ImportFormat>> named_values(ImportFormat) {
  static constexpr std::array<NamedValue<ImportFormat>, 2> values{
      {{"kinect2", ImportFormat::kinect2}, {"correlation", ImportFormat::correlation}}};
  return values;
}

std::optional<ImageF> ImportedTruth::range_m(int index, Eigen::Index rows,
                                             Eigen::Index cols) const {
  if (folder_.empty()) return std::nullopt;
  char name[24];
  std::snprintf(name, sizeof name, "%06d.png", index);
  const fs::path file = folder_ / "range_truth" / name;
  if (!is_there(file)) return std::nullopt;
  const ImageU16 range_mm = read_png_16(file);
  if (range_mm.rows() != rows || range_mm.cols() != cols) {
    throw InputError(fmt::format("{}: is {} x {} pixels, but the camera has {} x {}", file.string(),
                                 range_mm.cols(), range_mm.rows(), cols, rows));
  }
  return (range_mm == 0).select(nan, range_mm.cast<float>() / 1000.0F);
}

void ImportedTruth::copy_to(const fs::path& sequence) const {
  if (folder_.empty()) return;
  for (const char* name : {"groundtruth.txt", "scene.ply", "furniture.json"}) {
    if (!is_there(folder_ / name)) continue;
    std::error_code error;
    fs::copy_file(folder_ / name, sequence / name, error);
    if (error) {
      throw InputError((folder_ / name).string() + ": cannot be copied to " +
                       (sequence / name).string() + " (" + error.message() + ")");
    }
  }
}

ImportedRecording open_import(const ImportInput& input) {
  return input.format == ImportFormat::kinect2 ? open_kinect2(input) : open_correlation(input);
}

}  // namespace tofmap::app

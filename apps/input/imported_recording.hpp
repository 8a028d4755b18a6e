// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tofmap/acquisition/frame_source.hpp>
#include <tofmap/core/named_value.hpp>

namespace tofmap::app {

/// The formats of other programs that can be imported.
enum class ImportFormat : std::uint8_t {
  kinect2,      ///< packets of a Kinect v2 (docs/import-kinect2.md)
  correlation,  ///< arrays of correlation images (docs/import-correlation.md)
};

std::span<const NamedValue<ImportFormat>> named_values(ImportFormat);

/// What is to be imported.
struct ImportInput {
  ImportFormat format = ImportFormat::kinect2;
  std::filesystem::path path;
  std::filesystem::path p0;  ///< P0 tables in place of the recording's; empty: the recording's
  bool keep_inconsistent = false;  ///< keep phases of inconsistent pixels
};

/// The truth beside a simulated recording, as tofmap writes it (docs/sequence-format.md).
class ImportedTruth {
 public:
  /// An empty folder stands for no truth.
  explicit ImportedTruth(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

  /// The true ranges of the frame of this index. Empty if there are none. Throws InputError if they
  /// cannot be read or do not have this size.
  std::optional<ImageF> range_m(int index, Eigen::Index rows, Eigen::Index cols) const;

  /// Copies groundtruth.txt, scene.ply and furniture.json, if they exist, into the folder of a
  /// sequence. Throws InputError if a file cannot be copied.
  void copy_to(const std::filesystem::path& sequence) const;

 private:
  std::filesystem::path folder_;
};

/// A recording of another program, opened for import.
struct ImportedRecording {
  std::unique_ptr<FrameSource> source;
  /// Number of inconsistent pixels of all frames so far. Empty if the format cannot tell.
  std::function<std::int64_t()> inconsistent_pixels;
  /// For each frequency, how large the residuals of the steps are relative to the amplitude
  /// (CorrelationSource::relative_residuals). Empty if the format has no residuals.
  std::function<std::vector<double>()> relative_residuals;
  std::vector<std::string> warnings;  ///< what is assumed, and what is missing
  ImportedTruth truth;
};

/// Opens a recording. Throws InputError if it cannot be read or is of another kind, and UsageError
/// if an argument does not belong to the format. Messages name a remedy.
ImportedRecording open_import(const ImportInput& input);

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "file_pattern.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <tofmap/acquisition/correlation/array_file.hpp>
#include <tofmap/acquisition/correlation/array_layout.hpp>
#include <tofmap/acquisition/correlation/correlation_description.hpp>
#include <tofmap/acquisition/correlation/step_values.hpp>

namespace tofmap {

/// The images that array files hold, frame by frame. One object must not be used by two threads at
/// once.
class ImageFiles {
 public:
  /// `steps` is the number of steps of each frequency. `frames` is the number of frames if it is
  /// known, else 0; it counts for raw binary files, which do not tell it. Opens the files, unless
  /// each frame has files of its own: then looks which frames exist. Throws InputError if a file of
  /// all frames is missing or contradicts the description, or if no frame exists.
  ImageFiles(ArrayFiles files, std::filesystem::path folder, std::vector<int> steps,
             const CameraModel& camera, StepValues values, std::int64_t frames);

  int frame_count() const { return static_cast<int>(frames_.size()); }

  /// The number that a frame has in file names; its index if names have no {frame}.
  std::int64_t number(int frame) const { return frames_[static_cast<std::size_t>(frame)]; }

  /// Why a frame cannot be read, as far as it shows without reading it: a file that is missing or
  /// too short. Empty if nothing does.
  std::string damage(int frame) const;

  /// The images of a frame by frequency and step. Throws InputError if a file is missing, too short
  /// or damaged.
  std::vector<std::vector<StepImage>> read(int frame);

 private:
  struct OpenFile {
    ArrayFile file;
    ArrayLayout layout;
  };
  using OpenFiles = std::map<std::filesystem::path, OpenFile>;

  FilePattern::Numbers numbers_of(std::int64_t frame, int frequency, int step) const;
  std::filesystem::path path_of(const FilePattern::Numbers& numbers) const;
  OpenFile open(const std::filesystem::path& path, int frequency) const;
  void open_all();
  void find_frames();

  ArrayFiles files_;
  FilePattern pattern_;
  std::filesystem::path folder_;
  std::vector<int> steps_;
  ArraySizes sizes_;
  StepValues values_;
  std::int64_t expected_frames_ = 0;
  bool has_files_a_frame_ = false;    ///< each frame has files of its own
  OpenFiles open_;                    ///< files of all frames
  std::vector<std::int64_t> frames_;  ///< their numbers in file names
};

}  // namespace tofmap

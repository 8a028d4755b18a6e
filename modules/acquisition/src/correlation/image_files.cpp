// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "image_files.hpp"

#include <algorithm>
#include <numeric>
#include <system_error>
#include <utility>

#include <tofmap/core/error.hpp>

namespace tofmap {

ImageFiles::ImageFiles(ArrayFiles files, std::filesystem::path folder, std::vector<int> steps,
                       const CameraModel& camera, StepValues values, std::int64_t frames)
    : files_(std::move(files)),
      pattern_(files_.pattern, files_.frequency_names, files_.step_names),
      folder_(std::move(folder)),
      steps_(std::move(steps)),
      values_(std::move(values)),
      expected_frames_(files_.frames > 0 ? files_.frames : frames),
      has_files_a_frame_(pattern_.has(ArrayAxis::frame)) {
  sizes_.frequencies = static_cast<std::int64_t>(steps_.size());
  sizes_.steps = *std::ranges::max_element(steps_);
  sizes_.images = static_cast<std::int64_t>(files_.images.size());
  sizes_.rows = camera.height_px;
  sizes_.columns = camera.width_px;
  has_files_a_frame_ ? find_frames() : open_all();
}

FilePattern::Numbers ImageFiles::numbers_of(std::int64_t frame, int frequency, int step) const {
  FilePattern::Numbers numbers{.frame = frame, .frequency = frequency, .step = step};
  if (files_.images.empty()) return numbers;
  const auto found = std::ranges::find(files_.images, StepPlace{frequency, step});
  if (found == files_.images.end()) {
    throw InputError(files_.pattern + ": the list of images has no entry for step " +
                     std::to_string(step) + " of frequency " + std::to_string(frequency));
  }
  numbers.image = static_cast<int>(found - files_.images.begin());
  return numbers;
}

std::filesystem::path ImageFiles::path_of(const FilePattern::Numbers& numbers) const {
  return folder_ / pattern_.path(numbers);
}

ImageFiles::OpenFile ImageFiles::open(const std::filesystem::path& path, int frequency) const {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown) && !unknown) {
    throw InputError(path.string() + ": does not exist");
  }
  ArrayFile file(path, files_.options);
  naming(path.string(), [&] { check_values(values_, file.type()); });
  ArraySizes sizes = sizes_;
  if (pattern_.has(ArrayAxis::frequency)) {
    sizes.steps = steps_[static_cast<std::size_t>(frequency)];
  }
  // Other files tell the number of frames themselves.
  const bool is_raw = file.shape() == ArrayFile::Shape::unknown;
  if (is_raw || files_.frames > 0) sizes.frames = expected_frames_;
  ArrayLayout layout = array_layout(file, files_.axes, sizes, files_.reshape);
  return {std::move(file), std::move(layout)};
}

void ImageFiles::open_all() {
  std::int64_t frames = 0;
  for (int frequency = 0; frequency < sizes_.frequencies; ++frequency) {
    for (int step = 0; step < steps_[static_cast<std::size_t>(frequency)]; ++step) {
      const std::filesystem::path path = path_of(numbers_of(0, frequency, step));
      if (open_.contains(path)) continue;
      const auto opened = open_.emplace(path, open(path, frequency)).first;
      frames = std::max(frames, opened->second.layout.frames);
    }
  }
  frames_.resize(static_cast<std::size_t>(frames));
  std::iota(frames_.begin(), frames_.end(), 0);
}

void ImageFiles::find_frames() {
  if (files_.frames > 0) {
    frames_.resize(static_cast<std::size_t>(files_.frames));
    std::iota(frames_.begin(), frames_.end(), files_.first_frame);
    return;
  }
  const std::set<std::int64_t> found = pattern_.frames_below(folder_);
  frames_.assign(found.begin(), found.end());
  if (!frames_.empty()) return;
  throw InputError((folder_ / files_.pattern).string() + ": no file has such a name");
}

std::string ImageFiles::damage(int frame) const {
  const std::int64_t number = frames_[static_cast<std::size_t>(frame)];
  for (const auto& [path, opened] : open_) {
    if (holds_frame(opened.file, opened.layout, number)) continue;
    return path.string() + ": is too short for frame " + std::to_string(frame) +
           "; is it truncated, or are data.byte_offset, data.type, data.axes and the camera's size "
           "not those of the file?";
  }
  if (!has_files_a_frame_) return "";
  for (int frequency = 0; frequency < sizes_.frequencies; ++frequency) {
    for (int step = 0; step < steps_[static_cast<std::size_t>(frequency)]; ++step) {
      const std::filesystem::path path = path_of(numbers_of(number, frequency, step));
      std::error_code unknown;
      if (!std::filesystem::exists(path, unknown) && !unknown) {
        return path.string() + ": does not exist";
      }
    }
  }
  return "";
}

std::vector<std::vector<StepImage>> ImageFiles::read(int frame) {
  const std::int64_t number = frames_[static_cast<std::size_t>(frame)];
  OpenFiles open_now;  // those of this frame alone
  OpenFiles& open_files = has_files_a_frame_ ? open_now : open_;
  std::map<std::filesystem::path, std::vector<std::byte>> bytes;
  std::vector<std::vector<StepImage>> images(steps_.size());
  for (int frequency = 0; frequency < sizes_.frequencies; ++frequency) {
    for (int step = 0; step < steps_[static_cast<std::size_t>(frequency)]; ++step) {
      const FilePattern::Numbers numbers = numbers_of(number, frequency, step);
      const std::filesystem::path path = path_of(numbers);
      auto opened = open_files.find(path);
      if (opened == open_files.end()) {
        opened = open_files.emplace(path, open(path, frequency)).first;
      }
      ArrayFile& file = opened->second.file;
      const ArrayLayout& layout = opened->second.layout;
      if (!bytes.contains(path)) {
        bytes[path] = read_frame(file, layout, has_files_a_frame_ ? 0 : number);
      }
      const std::int64_t first = frequency * layout.stride_in_frame(ArrayAxis::frequency) +
                                 step * layout.stride_in_frame(ArrayAxis::step) +
                                 numbers.image * layout.stride_in_frame(ArrayAxis::image);
      images[static_cast<std::size_t>(frequency)].push_back(naming(path.string(), [&] {
        return step_image(bytes[path], file.type(), layout, first, values_);
      }));
    }
  }
  return images;
}

}  // namespace tofmap

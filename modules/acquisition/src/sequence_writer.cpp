// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sequence_header.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <limits>
#include <sstream>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

constexpr double full_scale = 65535;  // largest value of 16 bits

[[noreturn]] void fail_to_write(const std::filesystem::path& file) {
  throw InputError(file.string() +
                   ": cannot be written; is the disk full, or is permission missing?");
}

void make_empty_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw InputError(folder.string() + ": cannot be created: " + error.message());
  }
  const bool empty = std::filesystem::is_empty(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be read: " + error.message());
  if (!empty) {
    throw InputError(folder.string() + ": is not empty; a sequence needs a folder of its own");
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be created: " + error.message());
}

/// Encodes every pixel with `encode`, which returns the 16-bit value as a double. Throws
/// UsageError, which names `what` and the pixel, if a value does not fit into 16 bits.
template <class Encode>
ImageU16 encoded(const ImageF& image, const char* what, const Encode& encode) {
  ImageU16 pixels(image.rows(), image.cols());
  for (Eigen::Index i = 0; i < image.size(); ++i) {
    const double value = encode(static_cast<double>(image.data()[i]));
    if (!(value >= 0 && value <= full_scale)) {
      std::ostringstream message;
      message << what << " " << image.data()[i] << " of pixel (" << i % image.cols() << ", "
              << i / image.cols() << ") does not fit into 16 bits";
      throw UsageError(message.str());
    }
    pixels.data()[i] = static_cast<std::uint16_t>(value);
  }
  return pixels;
}

ImageU16 phase_pixels(const ImageF& phase) {
  return encoded(phase, "the phase", [](double cycles) {
    if (std::isnan(cycles)) return full_scale;
    if (!(cycles >= 0 && cycles < 1)) return -1.0;
    const double value = std::round(cycles * full_scale);
    return value < full_scale ? value : 0.0;  // rounds up to a whole cycle, which is phase 0
  });
}

ImageU16 amplitude_pixels(const ImageF& amplitude, double scale) {
  return encoded(amplitude, "the amplitude", [&](double value) {
    return value > 0 ? std::clamp(std::round(value * scale), 1.0, full_scale) : value;
  });
}

std::string image_name(int index) {
  char name[24];
  std::snprintf(name, sizeof name, "%06d.png", index);
  return name;
}

/// The kind of an image, which is also the name of its folder: "phase_a".
std::string image_kind(const char* of, std::size_t frequency) {
  return std::string(of) + frequency_letter(frequency);
}

template <class T>
void check_size(const Image<T>& image, const CameraModel& camera, const std::string& what) {
  if (image.cols() == camera.width_px && image.rows() == camera.height_px) return;
  throw UsageError(what + " is " + std::to_string(image.cols()) + " x " +
                   std::to_string(image.rows()) + " pixels; the camera has " +
                   std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px));
}

}  // namespace

ImageU16 range_truth_pixels(const ImageF& range_m) {
  return encoded(range_m, "the range", [](double range) {
    const double millimetres = std::round(range * 1000);
    return millimetres >= 1 && millimetres <= full_scale ? millimetres : 0.0;  // 0: unknown
  });
}

SequenceWriter::SequenceWriter(std::filesystem::path folder, const SensorModel& sensor,
                               double amplitude_scale)
    : folder_(std::move(folder)),
      sensor_(sensor),
      amplitude_scale_(amplitude_scale),
      last_timestamp_s_(-std::numeric_limits<double>::infinity()) {
  if (!(std::isfinite(amplitude_scale) && amplitude_scale > 0)) {
    throw UsageError("amplitude_scale must be a positive number");
  }
  validate(sensor.camera);
  validate(sensor.modulation);
  make_empty_folder(folder_);
  const std::size_t frequencies = sensor.modulation.count();
  for (std::size_t f = 0; f < frequencies; ++f) make_folder(folder_ / image_kind("phase_", f));

  const std::filesystem::path header = folder_ / "sequence.yaml";
  std::ofstream out(header);
  out << sequence_header_text(sensor_);
  out.close();
  if (!out) fail_to_write(header);

  frames_.open(folder_ / "frames.txt");
  frames_ << "# timestamp";
  for (std::size_t f = 0; f < frequencies; ++f) frames_ << ' ' << image_kind("phase_", f);
  for (std::size_t f = 0; f < frequencies; ++f) frames_ << ' ' << image_kind("amplitude_", f);
  frames_ << '\n' << std::flush;
  if (!frames_) fail_to_write(folder_ / "frames.txt");
}

void SequenceWriter::add(const Frame& frame, const std::optional<Pose>& world_from_camera,
                         const std::optional<ImageF>& range_truth_m,
                         const std::optional<ImageU8>& label_truth,
                         const std::optional<ImageU8>& moving_truth) {
  // Rounded as in the file: timestamps that differ by less than a microsecond would read back
  // equal.
  const double timestamp_s = std::round(frame.timestamp_s * 1e6) / 1e6;
  if (!(std::isfinite(timestamp_s) && timestamp_s > last_timestamp_s_)) {
    throw UsageError("frame timestamps must increase: " + std::to_string(frame.timestamp_s) +
                     " s follows " + std::to_string(last_timestamp_s_) + " s");
  }
  if (frame.frequencies() != sensor_.modulation.count()) {
    throw UsageError("a frame has " + counted(frame.frequencies(), "frequency", "frequencies") +
                     "; the sequence has " + std::to_string(sensor_.modulation.count()));
  }
  const std::string name = image_name(count_);
  std::ostringstream line;
  line << std::fixed << std::setprecision(6) << timestamp_s;
  const auto write = [&](const std::string& kind, const auto& image, const auto& pixels) {
    check_size(image, sensor_.camera, kind);
    make_folder(folder_ / kind);
    write_png(folder_ / kind / name, pixels);
    line << ' ' << kind << '/' << name;
  };
  const std::size_t frequencies = sensor_.modulation.count();
  for (std::size_t f = 0; f < frequencies; ++f) {
    write(image_kind("phase_", f), frame.phases[f], phase_pixels(frame.phases[f]));
  }
  for (std::size_t f = 0; f < frequencies; ++f) {
    if (!frame.has_amplitude()) {
      line << " -";
      continue;
    }
    const ImageF& amplitude = frame.amplitudes[f];
    write(image_kind("amplitude_", f), amplitude, amplitude_pixels(amplitude, amplitude_scale_));
  }
  const std::string listed = line.str();
  if (range_truth_m) write("range_truth", *range_truth_m, range_truth_pixels(*range_truth_m));
  if (label_truth) write("label_truth", *label_truth, *label_truth);
  if (moving_truth) write("moving_truth", *moving_truth, *moving_truth);

  if (world_from_camera) {
    const std::filesystem::path file = folder_ / "groundtruth.txt";
    if (!ground_truth_.is_open()) {
      ground_truth_.open(file);
      ground_truth_ << "# timestamp tx ty tz qx qy qz qw\n";
    }
    write_pose(ground_truth_, {timestamp_s, *world_from_camera});
    if (!ground_truth_.flush()) fail_to_write(file);
  }
  // Written last, so that a frame is listed only when all its files exist.
  frames_ << listed << '\n' << std::flush;
  if (!frames_) fail_to_write(folder_ / "frames.txt");
  last_timestamp_s_ = timestamp_s;
  ++count_;
}

}  // namespace tofmap

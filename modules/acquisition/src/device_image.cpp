// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/device_image.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include <boost/crc.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

constexpr double most_steps = 65534;  // an .oni file returns the depth 65535 as 1

/// The bytes "tofmap".
constexpr std::array<std::uint16_t, 3> magic = {0x6f74, 0x6d66, 0x7061};

/// The version of the tag's layout: 1 for two frequencies, else 2, which has their number.
constexpr std::uint64_t tag_version_of_pairs = 1;
constexpr std::uint64_t latest_tag_version = 2;

/// Writes the values of a tag as words of 16 bits, the low word first. Floating-point numbers are
/// written as their bits.
class TagWriter {
 public:
  TagWriter() : words_(magic.begin(), magic.end()) {}

  void add(std::uint64_t value, int words) {
    for (int i = 0; i < words; ++i, value >>= 16) {
      words_.push_back(static_cast<std::uint16_t>(value));
    }
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value), 4); }

  const std::vector<std::uint16_t>& words() const { return words_; }

 private:
  std::vector<std::uint16_t> words_;
};

/// Reads the values that TagWriter wrote, in the same order.
class TagReader {
 public:
  explicit TagReader(const std::vector<std::uint16_t>& words)
      : word_(words.begin() + magic.size()) {}

  std::uint64_t whole(int words) {
    std::uint64_t value = 0;
    for (int i = 0; i < words; ++i) value |= std::uint64_t{*word_++} << (16 * i);
    return value;
  }
  double number() { return std::bit_cast<double>(whole(4)); }

 private:
  std::vector<std::uint16_t>::const_iterator word_;
};

std::uint32_t checksum(const std::vector<std::uint16_t>& words, std::size_t count) {
  boost::crc_32_type crc;
  for (std::size_t i = 0; i < count; ++i) {
    crc.process_byte(static_cast<unsigned char>(words[i] & 0xff));
    crc.process_byte(static_cast<unsigned char>(words[i] >> 8));
  }
  return crc.checksum();
}

constexpr int checksum_words = 2;

std::vector<std::uint16_t> words_of(const FrameTag& tag) {
  TagWriter out;
  const std::vector<double>& hz = tag.sensor.modulation.frequencies_hz;
  const bool is_pair = hz.size() == 2;
  out.add(is_pair ? tag_version_of_pairs : latest_tag_version, 1);
  if (!is_pair) out.add(hz.size(), 1);
  out.add(tag.number, 2);
  out.add(tag.timestamp_s);
  const CameraModel& camera = tag.sensor.camera;
  out.add(static_cast<std::uint64_t>(camera.width_px), 1);
  out.add(static_cast<std::uint64_t>(camera.height_px), 1);
  for (const double value : {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px})
    out.add(value);
  for (const double value : camera.distortion) out.add(value);
  for (const double value : hz) out.add(value);
  out.add(tag.sensor.max_range_m);
  out.add(tag.sensor.saturation_amplitude);
  out.add(tag.scale.unit_m);
  out.add(tag.scale.is_z_depth ? 1 : 0, 1);
  out.add(checksum(out.words(), out.words().size()), checksum_words);
  return out.words();
}

FrameTag tag_of(const std::vector<std::uint16_t>& words) {
  TagReader in(words);
  FrameTag tag;
  const std::uint64_t version = in.whole(1);
  std::vector<double>& hz = tag.sensor.modulation.frequencies_hz;
  hz.resize(version == tag_version_of_pairs ? 2 : in.whole(1));
  tag.number = static_cast<std::uint32_t>(in.whole(2));
  tag.timestamp_s = in.number();
  CameraModel& camera = tag.sensor.camera;
  camera.width_px = static_cast<int>(in.whole(1));
  camera.height_px = static_cast<int>(in.whole(1));
  for (double* value : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px}) {
    *value = in.number();
  }
  for (double& value : camera.distortion) value = in.number();
  for (double& value : hz) value = in.number();
  tag.sensor.max_range_m = in.number();
  tag.sensor.saturation_amplitude = in.number();
  tag.scale.unit_m = in.number();
  tag.scale.is_z_depth = in.whole(1) != 0;
  return tag;
}

std::size_t tag_words(std::size_t frequencies) {
  FrameTag tag;
  tag.sensor.modulation.frequencies_hz.resize(frequencies);
  return words_of(tag).size();
}

constexpr int pixels_per_word =
    2;  // one byte per pixel, since .oni files do not keep the depth 65535

void write_tag(ImageU16& image, const std::vector<std::uint16_t>& words, std::size_t frequencies) {
  const Eigen::Index rows = tag_rows(static_cast<int>(image.cols()), frequencies);
  image.bottomRows(rows).setZero();
  std::uint16_t* pixel = image.row(image.rows() - rows).data();
  for (const std::uint16_t word : words) {
    *pixel++ = word & 0xff;
    *pixel++ = word >> 8;
  }
}

std::vector<std::uint16_t> words_at(const std::uint16_t* pixel, std::size_t count) {
  std::vector<std::uint16_t> words(count);
  for (std::uint16_t& word : words) {
    word = static_cast<std::uint16_t>(pixel[0] | pixel[1] << 8);
    pixel += pixels_per_word;
  }
  return words;
}

/// The tag of an image at this number of frequencies, on which its place depends.
std::optional<FrameTag> read_tag(const ImageU16& image, std::size_t frequencies) {
  const Eigen::Index rows = tag_rows(static_cast<int>(image.cols()), frequencies);
  if (image.rows() < rows) return std::nullopt;
  const std::vector<std::uint16_t> words =
      words_at(image.row(image.rows() - rows).data(), tag_words(frequencies));
  if (!std::equal(magic.begin(), magic.end(), words.begin())) return std::nullopt;
  const std::size_t checked = words.size() - checksum_words;
  const std::uint32_t sum = words[checked] | std::uint32_t{words[checked + 1]} << 16;
  if (sum != checksum(words, checked)) return std::nullopt;
  const std::uint16_t version = words[magic.size()];
  const bool fits = frequencies == 2
                        ? version == tag_version_of_pairs
                        : version == latest_tag_version && words[magic.size() + 1] == frequencies;
  return fits ? std::optional(tag_of(words)) : std::nullopt;
}

}  // namespace

int tag_rows(int width_px, std::size_t frequencies) {
  const int pixels = pixels_per_word * static_cast<int>(tag_words(frequencies));
  return (pixels + width_px - 1) / width_px;
}

std::optional<FrameTag> read_tag(const ImageU16& image) {
  if (image.cols() == 0) return std::nullopt;
  for (std::size_t frequencies = 1; frequencies <= most_frequencies; ++frequencies) {
    if (std::optional<FrameTag> tag = read_tag(image, frequencies)) return tag;
  }
  return std::nullopt;
}

DeviceImageCodec::DeviceImageCodec(const SensorModel& sensor, const RangeScale& scale)
    : sensor_(sensor), scale_(scale) {
  const double longest_m = longest_wavelength_m(sensor.modulation);
  if (!(longest_m / scale.unit_m <= most_steps)) {
    throw UsageError("ranges up to " + std::to_string(longest_m) +
                     " m do not fit into 16 bits at " + std::to_string(1000 * scale.unit_m) +
                     " mm per step; use a coarser unit");
  }
  steps_per_m_ = ImageF::Constant(sensor.camera.height_px, sensor.camera.width_px,
                                  static_cast<float>(1 / scale.unit_m));
  if (scale.is_z_depth) steps_per_m_ *= pixel_rays(sensor.camera).z;
}

ImageU16 DeviceImageCodec::encode_range(const ImageF& phase, double wavelength_m) const {
  return phase.binaryExpr(steps_per_m_, [wavelength_m](float cycles, float steps_per_m) {
    if (std::isnan(cycles)) return std::uint16_t{0};
    const double wavelength_steps = wavelength_m * double{steps_per_m};
    const double steps = std::round(double{cycles} * wavelength_steps);
    return static_cast<std::uint16_t>(steps > 0 ? steps : std::round(wavelength_steps));
  });
}

ImageF DeviceImageCodec::decode_range(const Eigen::Ref<const ImageU16>& range,
                                      double wavelength_m) const {
  if (!same_size(range, steps_per_m_)) throw UsageError("an image does not have the camera's size");
  return range.cast<float>().binaryExpr(
      steps_per_m_, [wavelength_m](float steps, float steps_per_m) {
        if (steps == 0) return nan;
        const double wavelength_steps = wavelength_m * double{steps_per_m};
        if (double{steps} > std::round(wavelength_steps)) return nan;
        const auto cycles = static_cast<float>(double{steps} / wavelength_steps);
        return cycles < 1 ? cycles : 0.0F;
      });
}

int DeviceImageCodec::count_beyond(const Eigen::Ref<const ImageU16>& range,
                                   double wavelength_m) const {
  const auto longest = (steps_per_m_.cast<double>() * wavelength_m).round();
  return static_cast<int>((range.cast<double>() > longest).count());
}

StackedImages DeviceImageCodec::stack(const Frame& frame, std::uint32_t number) const {
  const Eigen::Index rows = sensor_.camera.height_px;
  const Eigen::Index cols = sensor_.camera.width_px;
  const Modulation& modulation = sensor_.modulation;
  const auto frequencies = static_cast<Eigen::Index>(modulation.count());
  const Eigen::Index all_rows =
      frequencies * rows + tag_rows(sensor_.camera.width_px, modulation.count());
  StackedImages out{ImageU16(all_rows, cols), ImageU16::Zero(all_rows, cols)};
  for (std::size_t f = 0; f < modulation.count(); ++f) {
    const Eigen::Index first = static_cast<Eigen::Index>(f) * rows;
    out.range.middleRows(first, rows) = encode_range(frame.phases[f], modulation.wavelength_m(f));
    if (!frame.has_amplitude()) continue;
    out.amplitude.middleRows(first, rows) = encode_amplitude(frame.amplitudes[f]);
  }
  const auto words = words_of({number, frame.timestamp_s, sensor_, scale_});
  write_tag(out.range, words, modulation.count());
  write_tag(out.amplitude, words, modulation.count());
  return out;
}

void DeviceImageCodec::check_stack(const ImageU16& image) const {
  const CameraModel& camera = sensor_.camera;
  const std::size_t frequencies = sensor_.modulation.count();
  const int all_rows = static_cast<int>(frequencies) * camera.height_px;
  const bool fits = image.cols() == camera.width_px &&
                    (image.rows() == all_rows ||
                     image.rows() == all_rows + tag_rows(camera.width_px, frequencies));
  if (fits) return;
  throw UsageError("an image of " + std::to_string(image.cols()) + " x " +
                   std::to_string(image.rows()) + " pixels does not hold " +
                   counted(frequencies, "image") + " of " + std::to_string(camera.width_px) +
                   " x " + std::to_string(camera.height_px));
}

Frame DeviceImageCodec::unstack(const ImageU16& range, const ImageU16& amplitude) const {
  check_stack(range);
  if (amplitude.size() > 0) check_stack(amplitude);
  const Eigen::Index rows = sensor_.camera.height_px;
  Frame frame;
  for (std::size_t f = 0; f < sensor_.modulation.count(); ++f) {
    const Eigen::Index first = static_cast<Eigen::Index>(f) * rows;
    frame.phases.push_back(
        decode_range(range.middleRows(first, rows), sensor_.modulation.wavelength_m(f)));
    if (amplitude.size() == 0) continue;
    frame.amplitudes.push_back(decode_amplitude(amplitude.middleRows(first, rows)));
  }
  return frame;
}

ImageU16 encode_amplitude(const ImageF& amplitude) {
  return amplitude.unaryExpr([](float value) {
    if (!(value > 0)) return std::uint16_t{0};
    return static_cast<std::uint16_t>(std::clamp(std::round(value), 1.0F, 65535.0F));
  });
}

ImageF decode_amplitude(const Eigen::Ref<const ImageU16>& amplitude) {
  return amplitude.cast<float>();
}

}  // namespace tofmap

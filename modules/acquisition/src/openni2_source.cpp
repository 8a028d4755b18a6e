// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/openni2_source.hpp"

#include "openni2_connection.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <mutex>
#include <numbers>
#include <sstream>
#include <utility>

#include <tofmap/acquisition/device_image.hpp>
#include <tofmap/acquisition/openni2_properties.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Smallest share and smallest number of pixels with ranges beyond a wavelength that chance and
/// noise cannot explain.
constexpr double telling_share = 0.001;
constexpr int least_telling = 3;

/// If this many images make no frame, the options do not fit the device.
constexpr int most_fruitless_images = 200;

/// True if chance and noise cannot explain that `beyond` of `pixels` have ranges beyond a
/// wavelength.
bool has_beyond(int beyond, Eigen::Index pixels) {
  return beyond >= std::max(least_telling * 1.0, telling_share * static_cast<double>(pixels));
}

/// The modulation frequencies of a device whose images carry no tag, in the order of its images.
std::vector<double> untagged_frequencies_hz(const std::string& uri, const OpenNi2Connection& device,
                                            const DeviceOptions& options) {
  if (!options.frequencies_hz.empty()) return options.frequencies_hz;
  std::vector<double> frequencies_hz = device.frequencies_hz();
  const double wanted_hz[] = {options.frequency_a_hz, options.frequency_b_hz};
  for (std::size_t f = 0; f < 2; ++f) {
    if (!(wanted_hz[f] > 0)) continue;
    frequencies_hz.resize(std::max(frequencies_hz.size(), f + 1));
    frequencies_hz[f] = wanted_hz[f];
  }
  if (frequencies_hz.empty() || std::ranges::min(frequencies_hz) <= 0) {
    throw UsageError(uri + ": does not report its modulation frequencies; set " +
                     "device.frequencies_hz");
  }
  return frequencies_hz;
}

/// The sensor of a device whose images carry no tag, from the options, the calibration and the
/// properties of the device.
SensorModel untagged_sensor(const std::string& uri, const OpenNi2Connection& device,
                            const RawImage& image, const OpenNi2Source::Settings& settings) {
  const DeviceOptions& options = settings.options;
  SensorModel sensor;
  sensor.modulation.frequencies_hz = untagged_frequencies_hz(uri, device, options);
  sensor.max_range_m = options.max_range_m;
  const auto images_in_one =
      options.layout == ImageLayout::stacked ? static_cast<int>(sensor.modulation.count()) : 1;
  const auto width = static_cast<int>(image.pixels.cols());
  const auto height = static_cast<int>(image.pixels.rows()) / images_in_one;
  const double view_rad = device.horizontal_fov_rad();
  if (settings.calibration.camera) {
    sensor.camera = *settings.calibration.camera;
  } else if (view_rad > 0 && view_rad < std::numbers::pi) {
    sensor.camera = pinhole_camera(view_rad, width, height);
  } else {
    throw InputError(uri + ": does not report its field of view; give a calibration with the " +
                     "camera's intrinsics (--calibration, docs/calibration.md)");
  }
  return sensor;
}

}  // namespace

bool is_device_uri(const std::string& text) {
  return text.find("://") != std::string::npos || text.ends_with(".oni");
}

/// Interprets the images of a device and makes frames of them.
class OpenNi2Source::Impl {
 public:
  Impl(const std::string& uri, Settings settings);

  const SensorModel& sensor() const { return sensor_; }
  std::optional<SourcedFrame> next();
  End end() const { return end_; }
  bool waits_for_reader() const { return device_.waits_for_reader(); }
  PairingCounts counts() const {
    const std::scoped_lock lock(mutex_);
    return counts_;
  }

 private:
  std::optional<RawImage> wait_for_image();
  void take_as_tagged(const FrameTag& tag);
  void take_as_configured(const RawImage& image);
  void begin(const SensorModel& sensor, const RangeScale& scale, ImageKey key);
  std::optional<DeviceImage> understand(RawImage image);
  std::optional<Frame> add(RawImage image);
  std::optional<Frame> frame_of(JoinedImages joined);
  double wavelength_exceeded_m(const ImageU16& range) const;
  Frame frame_of_images(const std::vector<JoinedImages>& images) const;
  SourcedFrame sourced(Frame frame);
  void check_fruit() const;
  std::string silence() const;

  std::string uri_;
  Settings settings_;
  OpenNi2Connection device_;
  SensorModel sensor_;
  std::optional<FrameTag> first_tag_;
  std::optional<DeviceImageCodec> codec_;
  std::optional<StreamJoiner> joiner_;
  std::optional<AlternatingJoiner> alternating_;
  std::deque<RawImage> early_;  ///< images that arrived before their meaning was known
  int index_ = 0;
  int images_ = 0;
  std::atomic<End> end_{End::none};
  mutable std::mutex mutex_;
  PairingCounts counts_;
};

OpenNi2Source::Impl::Impl(const std::string& uri, Settings settings)
    : uri_(uri), settings_(std::move(settings)), device_(uri, settings_.oni_file) {
  while (true) {
    std::optional<RawImage> image = wait_for_image();
    if (!image) {
      if (end_ == End::asked) return;
      if (end_ == End::timeout) throw InputError(uri_ + ": " + silence());
      throw InputError(uri_ + ": delivers no range images; is it the right device?");
    }
    early_.push_back(std::move(*image));
    const RawImage& latest = early_.back();
    if (latest.stream != DeviceStream::range) continue;
    const std::optional<FrameTag> tag = read_tag(latest.pixels);
    tag ? take_as_tagged(*tag) : take_as_configured(latest);
    return;
  }
}

void OpenNi2Source::Impl::begin(const SensorModel& sensor, const RangeScale& scale, ImageKey key) {
  naming(uri_, [&] {
    validate(sensor.camera);
    validate(sensor.modulation);
  });
  codec_.emplace(sensor, scale);
  joiner_.emplace(key, device_.has_amplitude());
  sensor_ = calibrated(sensor, settings_.calibration);
}

void OpenNi2Source::Impl::take_as_tagged(const FrameTag& tag) {
  if (settings_.options.layout == ImageLayout::alternating) {
    throw InputError(uri_ + ": its images say that they hold all frequencies; leave out " +
                     "device.layout=alternating");
  }
  first_tag_ = tag;
  begin(tag.sensor, tag.scale, ImageKey::number);
}

void OpenNi2Source::Impl::take_as_configured(const RawImage& image) {
  const DeviceOptions& options = settings_.options;
  if (options.layout == ImageLayout::by_tag) {
    throw UsageError(uri_ + ": its images do not say how they hold the frequencies; set " +
                     "device.layout to stacked or alternating (docs/cameras.md)");
  }
  SensorModel sensor = untagged_sensor(uri_, device_, image, settings_);
  const RangeScale scale{image.unit_m, options.depth == DepthKind::z};
  if (options.layout == ImageLayout::stacked) {
    begin(sensor, scale, ImageKey::time);
    return;
  }
  AlternatingJoiner::Settings joining;
  joining.period_s = options.period_s > 0 ? options.period_s : 1.0 / device_.frame_rate_hz();
  joining.wavelengths_m = wavelengths_m(sensor.modulation);
  if (options.first != FirstImage::by_ranges) {
    joining.first =
        static_cast<std::size_t>(options.first) - static_cast<std::size_t>(FirstImage::a);
  }
  // Version 1 of the sequence format, which two frequencies are written in, has no exposure times.
  if (sensor.modulation.count() != 2) {
    for (std::size_t f = 0; f < sensor.modulation.count(); ++f) {
      sensor.modulation.exposure_offsets_s.push_back(static_cast<double>(f) * joining.period_s);
    }
  }
  begin(sensor, scale, ImageKey::time);
  alternating_.emplace(std::move(joining));
}

std::optional<RawImage> OpenNi2Source::Impl::wait_for_image() {
  using Clock = std::chrono::steady_clock;
  const auto give_up =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(settings_.options.timeout_s));
  while (true) {
    if (settings_.keep_going && !settings_.keep_going()) {
      end_ = End::asked;
      return std::nullopt;
    }
    constexpr int slice_ms = 100;
    std::optional<RawImage> image = device_.wait_for_image(slice_ms);
    if (image) return image;
    if (device_.is_unplugged()) end_ = End::unplugged;
    if (device_.is_at_end()) end_ = End::of_recording;
    if (end_ == End::none && Clock::now() > give_up) end_ = End::timeout;
    if (end_ != End::none) return std::nullopt;
  }
}

/// Adds timestamp and key to an image. Empty if the images of the device carry tags, but this image
/// has no valid tag or one that differs from the first image's.
std::optional<DeviceImage> OpenNi2Source::Impl::understand(RawImage image) {
  DeviceImage understood{image.stream, 1e-6 * static_cast<double>(image.timestamp_us),
                         image.timestamp_us, std::move(image.pixels)};
  if (!first_tag_) return understood;
  const std::optional<FrameTag> tag = read_tag(understood.pixels);
  const bool is_alike = tag && tag->scale.unit_m == first_tag_->scale.unit_m &&
                        tag->scale.is_z_depth == first_tag_->scale.is_z_depth &&
                        tag->sensor.modulation == first_tag_->sensor.modulation &&
                        tag->sensor.camera.width_px == first_tag_->sensor.camera.width_px &&
                        tag->sensor.camera.height_px == first_tag_->sensor.camera.height_px;
  if (!is_alike) return std::nullopt;
  understood.timestamp_s = tag->timestamp_s;
  understood.key = tag->number;
  return understood;
}

/// The longest of the wavelengths that ranges exceed, 0 if they exceed none.
double OpenNi2Source::Impl::wavelength_exceeded_m(const ImageU16& range) const {
  double longest_m = 0;
  for (const double wavelength_m : wavelengths_m(sensor_.modulation)) {
    if (wavelength_m > longest_m &&
        has_beyond(codec_->count_beyond(range, wavelength_m), range.size())) {
      longest_m = wavelength_m;
    }
  }
  return longest_m;
}

Frame OpenNi2Source::Impl::frame_of_images(const std::vector<JoinedImages>& images) const {
  Frame frame;
  frame.timestamp_s = images.front().timestamp_s;
  for (std::size_t f = 0; f < images.size(); ++f) {
    frame.phases.push_back(
        codec_->decode_range(images[f].range, sensor_.modulation.wavelength_m(f)));
  }
  if (std::ranges::all_of(images, &JoinedImages::has_amplitude)) {
    for (const JoinedImages& one : images) {
      frame.amplitudes.push_back(decode_amplitude(one.amplitude));
    }
  }
  return frame;
}

std::optional<Frame> OpenNi2Source::Impl::frame_of(JoinedImages joined) {
  if (!alternating_) {
    Frame frame = codec_->unstack(joined.range, joined.amplitude);
    frame.timestamp_s = joined.timestamp_s;
    return frame;
  }
  const double beyond_m = wavelength_exceeded_m(joined.range);
  const std::vector<JoinedImages> images = alternating_->add(std::move(joined), beyond_m, counts_);
  return images.empty() ? std::nullopt : std::optional(frame_of_images(images));
}

std::optional<Frame> OpenNi2Source::Impl::add(RawImage image) {
  const std::scoped_lock lock(mutex_);
  ++images_;
  std::optional<DeviceImage> understood = understand(std::move(image));
  if (!understood) {
    ++counts_.unreadable;
    return std::nullopt;
  }
  std::optional<JoinedImages> joined = joiner_->add(std::move(*understood), counts_);
  if (!joined) return std::nullopt;
  const int images = joined->has_amplitude() ? 2 : 1;
  try {
    return frame_of(std::move(*joined));
  } catch (const UsageError&) {  // the image does not have the camera's size
    counts_.paired -= images;
    counts_.unreadable += images;
    return std::nullopt;
  }
}

std::string OpenNi2Source::Impl::silence() const {
  std::ostringstream text;
  text << "no range image arrived within " << settings_.options.timeout_s
       << " s; is it the right device? A slow device needs a longer device.timeout_s";
  return text.str();
}

void OpenNi2Source::Impl::check_fruit() const {
  if (index_ > 0 || images_ < most_fruitless_images) return;
  throw InputError(uri_ + ": " + std::to_string(images_) +
                   " images made no frame: " + std::to_string(counts_.half_missing) +
                   " had no counterpart, " + std::to_string(counts_.undecided) +
                   " could be of several frequencies, " + std::to_string(counts_.unreadable) +
                   " had a wrong size or tag; do device.layout, device.period_s, device.first and "
                   "the frequencies fit the device?");
}

SourcedFrame OpenNi2Source::Impl::sourced(Frame frame) {
  SourcedFrame out;
  out.index = index_;
  out.timestamp_s = frame.timestamp_s;
  frame.index = index_++;
  calibrate(frame, sensor_.modulation, settings_.calibration);
  out.frame = std::move(frame);
  return out;
}

std::optional<SourcedFrame> OpenNi2Source::Impl::next() {
  if (settings_.most_frames > 0 && index_ == settings_.most_frames) end_ = End::asked;
  while (end_ == End::none) {
    std::optional<RawImage> image;
    if (early_.empty()) {
      image = wait_for_image();
    } else {
      image = std::move(early_.front());
      early_.pop_front();
    }
    if (!image) break;
    std::optional<Frame> frame = add(std::move(*image));
    if (frame) return sourced(std::move(*frame));
    check_fruit();
  }
  if (end_ == End::asked) return std::nullopt;  // waiting images might still have been completed
  const std::scoped_lock lock(mutex_);
  if (joiner_) joiner_->finish(counts_);
  if (alternating_) alternating_->finish(counts_);
  return std::nullopt;
}

OpenNi2Source::OpenNi2Source(const std::string& uri, Settings settings)
    : impl_(std::make_unique<Impl>(uri, std::move(settings))) {}
OpenNi2Source::~OpenNi2Source() = default;
const SensorModel& OpenNi2Source::sensor() const { return impl_->sensor(); }
std::optional<SourcedFrame> OpenNi2Source::next() { return impl_->next(); }
OpenNi2Source::End OpenNi2Source::end() const { return impl_->end(); }
bool OpenNi2Source::waits_for_reader() const { return impl_->waits_for_reader(); }
PairingCounts OpenNi2Source::counts() const { return impl_->counts(); }

}  // namespace tofmap

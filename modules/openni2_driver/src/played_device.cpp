// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "played_device.hpp"

#include "property_value.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <tofmap/acquisition/openni2_properties.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// The angle that the sides of an image span at the optical centre.
float field_of_view_rad(int side_px, double focal_length_px) {
  return static_cast<float>(2 * std::atan(side_px / (2 * focal_length_px)));
}

struct DepthFormat {
  OniPixelFormat format;
  double unit_m;
};

/// Ordered from fine to coarse.
constexpr DepthFormat depth_formats[] = {{ONI_PIXEL_FORMAT_DEPTH_100_UM, 1e-4},
                                         {ONI_PIXEL_FORMAT_DEPTH_1_MM, 1e-3}};

}  // namespace

PlayedDevice::PlayedDevice(const DeviceRequest& request, Events events)
    : request_(request),
      events_(std::move(events)),
      player_(request, [this] { return !is_ending(); }),
      speed_(request.player.speed) {
  const CameraModel& camera = player_.sensor().camera;
  const std::size_t frequencies = player_.sensor().modulation.count();
  const bool is_stacked = request.player.layout == PlayedLayout::stacked;
  OniVideoMode mode;
  mode.resolutionX = camera.width_px;
  mode.resolutionY = is_stacked ? static_cast<int>(frequencies) * camera.height_px +
                                      tag_rows(camera.width_px, frequencies)
                                : camera.height_px;
  const double images_per_frame = is_stacked ? 1 : static_cast<double>(frequencies);
  mode.fps = std::max(1, static_cast<int>(std::lround(images_per_frame / player_.period_s())));
  for (const DepthFormat& format : depth_formats) {
    try {
      codecs_.emplace_back(player_.sensor(),
                           RangeScale{format.unit_m, request.player.depth == DepthKind::z});
    } catch (const UsageError&) {
      continue;  // 16 bits of this format do not hold a wavelength
    }
    mode.pixelFormat = format.format;
    depth_.modes.push_back(mode);
  }
  if (codecs_.empty()) throw InputError("no pixel format holds ranges up to a wavelength");
  mode.pixelFormat = ONI_PIXEL_FORMAT_GRAY16;
  infrared_.modes.push_back(mode);
  depth_.horizontal_fov_rad = field_of_view_rad(camera.width_px, camera.fx_px);
  depth_.vertical_fov_rad = field_of_view_rad(camera.height_px, camera.fy_px);
  infrared_.horizontal_fov_rad = depth_.horizontal_fov_rad;
  infrared_.vertical_fov_rad = depth_.vertical_fov_rad;
  depth_.type = ONI_SENSOR_DEPTH;
  infrared_.type = ONI_SENSOR_IR;
  for (StreamDescription* stream : {&depth_, &infrared_}) {
    sensors_.push_back(
        {stream->type, static_cast<int>(stream->modes.size()), stream->modes.data()});
  }
  thread_ = std::thread([this] { play(); });
}

PlayedDevice::~PlayedDevice() {
  update([this] { is_closing_ = true; });
  thread_.join();
}

void PlayedDevice::update(const std::function<void()>& change) {
  {
    const std::scoped_lock lock(mutex_);
    change();
  }
  changed_.notify_all();
}

bool PlayedDevice::is_ending() {
  const std::scoped_lock lock(mutex_);
  return is_closing_ || is_unplugged_;
}

OniStatus PlayedDevice::getSensorInfoList(OniSensorInfo** sensors, int* count) {
  *sensors = sensors_.data();
  *count = static_cast<int>(sensors_.size());
  return ONI_STATUS_OK;
}

oni::driver::StreamBase* PlayedDevice::createStream(OniSensorType type) {
  if (type != ONI_SENSOR_DEPTH && type != ONI_SENSOR_IR) return nullptr;
  const std::scoped_lock lock(streams_mutex_);
  const StreamDescription& description = type == ONI_SENSOR_DEPTH ? depth_ : infrared_;
  // When a stream starts or stops, it is unknown whether images already delivered will be read.
  const auto on_change = [this] { update([this] { unread_ = 0; }); };
  streams_.push_back(std::make_shared<ImageStream>(description, on_change));
  return streams_.back().get();
}

void PlayedDevice::destroyStream(oni::driver::StreamBase* stream) {
  const std::scoped_lock lock(streams_mutex_);
  std::erase_if(streams_, [stream](const auto& one) { return one.get() == stream; });
}

/// A copy of the current streams, so that images are not delivered under streams_mutex_. OpenNI2
/// holds locks while it creates and destroys streams, and takes the same locks when it receives an
/// image.
PlayedDevice::Streams PlayedDevice::streams() {
  const std::scoped_lock lock(streams_mutex_);
  return streams_;
}

OniBool PlayedDevice::isPropertySupported(int id) {
  switch (id) {
    case ONI_DEVICE_PROPERTY_PLAYBACK_SPEED:
    case ONI_DEVICE_PROPERTY_DRIVER_VERSION:
    case openni2_property::frequency_a_hz:
    case openni2_property::frequency_b_hz:
    case openni2_property::frequencies_hz:
    case openni2_property::layout:
    case openni2_property::frames_delivered:
    case openni2_property::images_read:
      return TRUE;
    default:
      return FALSE;
  }
}

OniStatus PlayedDevice::getProperty(int id, void* data, int* size) {
  const Modulation& modulation = player_.sensor().modulation;
  switch (id) {
    case ONI_DEVICE_PROPERTY_PLAYBACK_SPEED: {
      const std::scoped_lock lock(mutex_);
      return answer(static_cast<float>(speed_), data, size);
    }
    case ONI_DEVICE_PROPERTY_DRIVER_VERSION:
      return answer(OniVersion{TOFMAP_VERSION_MAJOR, TOFMAP_VERSION_MINOR, TOFMAP_VERSION_PATCH, 0},
                    data, size);
    case openni2_property::frequency_a_hz:
      return answer(modulation.frequencies_hz[0], data, size);
    case openni2_property::frequency_b_hz:
      if (modulation.count() < 2) return ONI_STATUS_NOT_SUPPORTED;
      return answer(modulation.frequencies_hz[1], data, size);
    case openni2_property::frequencies_hz:
      return answer(std::span(modulation.frequencies_hz), data, size);
    case openni2_property::layout: {
      const std::string layout(name_of(request_.player.layout));
      return answer(std::span(layout.c_str(), layout.size() + 1), data, size);
    }
    case openni2_property::frames_delivered:
      return answer(frames_.load(), data, size);
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus PlayedDevice::setProperty(int id, const void* data, int size) {
  if (id == openni2_property::images_read) {
    const auto* count = given<int>(data, size);
    if (count == nullptr || *count < 0) return ONI_STATUS_BAD_PARAMETER;
    update([&] {
      hears_of_reads_ = true;
      unread_ = std::max(0, unread_ - *count);
    });
    return ONI_STATUS_OK;
  }
  if (id != ONI_DEVICE_PROPERTY_PLAYBACK_SPEED) return ONI_STATUS_NOT_SUPPORTED;
  const auto* wanted = given<float>(data, size);
  if (wanted == nullptr || !(*wanted >= 0 || *wanted == -1)) return ONI_STATUS_BAD_PARAMETER;
  update([&] {
    speed_ = double{*wanted};
    beginning_.reset();
  });
  return ONI_STATUS_OK;
}

OniBool PlayedDevice::isCommandSupported(int id) { return id == openni2_property::unplug; }

OniStatus PlayedDevice::invoke(int id, void* /*data*/, int /*size*/) {
  if (id != openni2_property::unplug) return ONI_STATUS_NOT_SUPPORTED;
  update([this] { is_unplugged_ = true; });
  return ONI_STATUS_OK;
}

OniStatus PlayedDevice::tryManualTrigger() {
  update([this] { is_triggered_ = true; });
  return ONI_STATUS_OK;
}

bool PlayedDevice::has_running_stream() {
  return std::ranges::any_of(streams(), [](const auto& stream) { return stream->is_running(); });
}

/// Waits until a stream is running. False if the device is to end instead.
bool PlayedDevice::wait_for_stream() {
  std::unique_lock lock(mutex_);
  while (!is_closing_ && !is_unplugged_) {
    lock.unlock();
    const bool is_running = has_running_stream();
    lock.lock();
    if (is_running) return true;
    beginning_.reset();                                // playback time stops
    constexpr std::chrono::milliseconds longest(100);  // a start since the check was missed
    changed_.wait_for(lock, longest);
    is_starting_ = true;
  }
  return false;
}

/// Waits a moment after the first stream has started: OpenNI2 accepts images only once it has noted
/// the start, and the client may start another stream.
void PlayedDevice::let_start() {
  std::unique_lock lock(mutex_);
  constexpr std::chrono::milliseconds ample(50);
  if (std::exchange(is_starting_, false)) {
    changed_.wait_for(lock, ample, [this] { return is_closing_ || is_unplugged_; });
  }
}

/// True if a client is waiting for an image and, as far as is known, has read the last one. The
/// caller holds mutex_. OpenNI2 triggers the device whenever a client begins to wait, even if the
/// client has read one of two delivered images and waits for the other, which the next image would
/// replace.
bool PlayedDevice::is_asked_for() {
  constexpr std::chrono::milliseconds to_read(10);
  constexpr std::chrono::seconds lost(1);  // later, OpenNI2 must have dropped the image
  const Clock::duration patience = hears_of_reads_ ? Clock::duration(lost) : to_read;
  return is_triggered_ && (unread_ == 0 || Clock::now() >= delivered_ + patience);
}

/// Waits until an image with this timestamp is due. False if the device is to end instead.
bool PlayedDevice::wait_for_turn(double timestamp_s) {
  std::unique_lock lock(mutex_);
  while (!is_closing_ && !is_unplugged_) {
    if (speed_ == 0) return true;
    if (speed_ < 0) {
      if (is_asked_for()) {
        is_triggered_ = false;
        unread_ = 0;
        return true;
      }
      constexpr std::chrono::milliseconds longest(10);
      changed_.wait_for(lock, longest);
      continue;
    }
    if (!beginning_) beginning_ = Beginning{Clock::now(), timestamp_s};
    const std::chrono::duration<double> after((timestamp_s - beginning_->timestamp_s) / speed_);
    const auto due = beginning_->moment + std::chrono::duration_cast<Clock::duration>(after);
    if (Clock::now() >= due) return true;
    changed_.wait_until(lock, due);
  }
  return false;
}

const DeviceImageCodec& PlayedDevice::codec() {
  for (const auto& stream : streams()) {
    if (stream->type() != ONI_SENSOR_DEPTH) continue;
    const auto mode =
        std::ranges::find(depth_.modes, stream->mode().pixelFormat, &OniVideoMode::pixelFormat);
    return codecs_[static_cast<std::size_t>(mode - depth_.modes.begin())];
  }
  return codecs_.front();
}

void PlayedDevice::deliver_images(const ImageU16& range, const ImageU16& amplitude,
                                  double timestamp_s) {
  const auto timestamp_us = static_cast<std::uint64_t>(std::llround(1e6 * timestamp_s));
  ++images_;
  const int lose_every = request_.player.lose_every;
  if (lose_every > 0 && images_ % lose_every == 0) {
    update([this] { is_triggered_ = true; });  // the client is still waiting
    return;
  }
  for (const auto& stream : streams()) {
    deliver_image(*stream, stream->type() == ONI_SENSOR_DEPTH ? range : amplitude, timestamp_us);
  }
}

void PlayedDevice::deliver_image(ImageStream& stream, const ImageU16& image,
                                 std::uint64_t timestamp_us) {
  if (!stream.is_running()) return;
  update([this] {
    ++unread_;  // before a client can report the image as read
    delivered_ = Clock::now();
  });
  stream.deliver(image, timestamp_us, images_);
}

void PlayedDevice::deliver(const Frame& frame) {
  if (!wait_for_turn(frame.timestamp_s)) return;
  // Encodes only now, because the mode of a stream, and with it the unit, may have changed
  // meanwhile.
  if (request_.player.layout == PlayedLayout::stacked) {
    const StackedImages images = codec().stack(frame, static_cast<std::uint32_t>(frames_.load()));
    deliver_images(images.range, images.amplitude, frame.timestamp_s);
    return;
  }
  const Modulation& modulation = player_.sensor().modulation;
  const ImageU16 no_amplitude = ImageU16::Zero(frame.rows(), frame.cols());
  const auto amplitude_of = [&](std::size_t f) {
    return frame.has_amplitude() ? encode_amplitude(frame.amplitudes[f]) : no_amplitude;
  };
  for (std::size_t f = 0; f < modulation.count(); ++f) {
    const double timestamp_s = frame.timestamp_s + player_.period_s() * static_cast<double>(f) /
                                                       static_cast<double>(modulation.count());
    if (f > 0 && !wait_for_turn(timestamp_s)) return;
    deliver_images(codec().encode_range(frame.phases[f], modulation.wavelength_m(f)),
                   amplitude_of(f), timestamp_s);
  }
}

void PlayedDevice::play() {
  try {
    while (wait_for_stream()) {
      let_start();
      const int unplug_at = request_.player.unplug_at;
      if (unplug_at > 0 && frames_ >= unplug_at) {
        // Gives delivered images time to arrive at the client.
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        update([this] { is_unplugged_ = true; });
        break;
      }
      const std::optional<Frame> frame = player_.next();
      if (!frame && !is_ending()) {
        events_.at_end();
        return;
      }
      if (!frame) break;
      deliver(*frame);
      ++frames_;
    }
    const bool is_unplugged = [this] {
      const std::scoped_lock lock(mutex_);
      return is_unplugged_ && !is_closing_;
    }();
    if (is_unplugged) events_.unplugged();
  } catch (const std::exception& error) {
    events_.failed(error.what());
  }
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "openni2_connection.hpp"

#include <chrono>
#include <cstring>
#include <mutex>
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <tofmap/acquisition/openni2_properties.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {
namespace {

/// The playback speed at which a device delivers one frame whenever a client waits for one.
constexpr float as_frames_are_asked_for = -1;

/// OpenNI2's message about the last failure, as one line.
std::string last_error() {
  std::istringstream words(openni::OpenNI::getExtendedError());
  std::string text;
  for (std::string word; words >> word;) text += (text.empty() ? "" : " ") + word;
  return text.empty() ? "OpenNI2 does not say why" : text;
}

void check(openni::Status status, const std::string& what) {
  if (status != openni::STATUS_OK) throw InputError(what + ": " + last_error());
}

/// Throws UsageError if OpenNI2's last error is a message of tofmap's driver about wrong use.
void refuse_wrong_use(const std::string& uri) {
  const std::string complaint = openni::OpenNI::getExtendedError();
  const std::string_view mark = openni2_property::usage_error;
  const std::size_t found = complaint.find(mark);
  if (found != std::string::npos) {
    const std::size_t begin = found + mark.size();
    throw UsageError(uri + ": " + complaint.substr(begin, complaint.find('\n', begin) - begin));
  }
}

/// Metres per step of a depth format; 0 for other formats.
double unit_of(openni::PixelFormat format) {
  switch (format) {
    case openni::PIXEL_FORMAT_DEPTH_100_UM:
      return 1e-4;
    case openni::PIXEL_FORMAT_DEPTH_1_MM:
      return 1e-3;
    default:
      return 0;
  }
}

/// Waits until the file is not empty and no longer grows, at most 30 s.
///
/// OpenNI2 writes files in its own thread. It reports neither when that thread has started, before
/// which images are not recorded, nor when it has written all images; those that remain when the
/// recorder stops are lost.
void wait_while_growing(const std::filesystem::path& file) {
  using namespace std::chrono_literals;
  constexpr auto still = 200ms;  // writing an image takes some milliseconds
  constexpr auto longest = 30s;
  std::uintmax_t last = 0;
  for (const auto give_up = std::chrono::steady_clock::now() + longest;
       std::chrono::steady_clock::now() < give_up;) {
    std::this_thread::sleep_for(still);
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (!error && size > 0 && size == last) return;
    last = error ? 0 : size;
  }
}

}  // namespace

OpenNi2Connection::Opened::Opened() { check(openni::OpenNI::initialize(), "OpenNI2"); }

OpenNi2Connection::Opened::~Opened() {
  depth.destroy();
  infrared.destroy();
  device.close();
  openni::OpenNI::shutdown();
}

OpenNi2Connection::Listener::Listener() {
  openni::OpenNI::addDeviceDisconnectedListener(this);
  openni::OpenNI::addDeviceStateChangedListener(this);
}

OpenNi2Connection::Listener::~Listener() {
  openni::OpenNI::removeDeviceDisconnectedListener(this);
  openni::OpenNI::removeDeviceStateChangedListener(this);
}

void OpenNi2Connection::Listener::onDeviceDisconnected(const openni::DeviceInfo* device) {
  if (uri == device->getUri()) is_unplugged = true;
}

void OpenNi2Connection::Listener::onDeviceStateChanged(const openni::DeviceInfo* device,
                                                       openni::DeviceState state) {
  constexpr auto end_of_file = static_cast<openni::DeviceState>(ONI_DEVICE_STATE_EOF);
  if (uri == device->getUri() && state == end_of_file) is_at_end = true;
}

OpenNi2Connection::OpenNi2Connection(const std::string& uri,
                                     const std::filesystem::path& oni_file) {
  open(uri);
  start(depth_, openni::SENSOR_DEPTH, uri);
  if (device_.hasSensor(openni::SENSOR_IR)) start(infrared_, openni::SENSOR_IR, uri);
  if (!oni_file.empty()) record(oni_file);
  check(depth_.start(), uri + ": its depth stream does not start");
  if (infrared_.isValid()) check(infrared_.start(), uri + ": its infrared stream does not start");
}

OpenNi2Connection::~OpenNi2Connection() {
  if (!is_file_) {
    depth_.stop();
    infrared_.stop();
  }
  if (recorder_.isValid()) end_recording();
  if (!is_file_) return;
  // While no stream of an .oni file runs, OpenNI2's player iterates over the streams without a
  // lock, and crashed in one of ten runs when they were destroyed at that time. Therefore the
  // streams keep running: the player waits for a request until the program ends. Each file occupies
  // some hundred kilobytes.
  // Without memory for a vector the program ends either way.
  // NOLINTNEXTLINE(bugprone-unhandled-exception-at-new)
  static auto* const never_closed = new std::vector<std::unique_ptr<Opened>>;
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);
  never_closed->push_back(std::move(opened_));
}

void OpenNi2Connection::open(const std::string& uri) {
  is_file_ = uri.find("://") == std::string::npos;
  if (is_file_ && std::filesystem::is_directory(uri)) {
    throw InputError(uri + ": is a folder; tofmap://" + std::filesystem::absolute(uri).string() +
                     " plays it as a camera if it is a recording");
  }
  if (is_file_ && !std::filesystem::is_regular_file(uri)) {
    throw InputError(uri + ": no such file; the URI of a device contains ://");
  }
  const openni::Status status = device_.open(uri.c_str());
  if (status != openni::STATUS_OK) refuse_wrong_use(uri);
  const bool is_own = uri.starts_with("tofmap://");
  check(status, uri + ": cannot be opened" +
                    (is_file_ ? "; is it a complete .oni file?"
                     : is_own ? ""
                              : "; is it plugged in, and is its driver installed?"));
  listener_.uri = device_.getDeviceInfo().getUri();
  if (!device_.hasSensor(openni::SENSOR_DEPTH)) throw InputError(uri + ": has no depth stream");
  if (openni::PlaybackControl* playback = device_.getPlaybackControl()) {
    playback->setRepeatEnabled(false);
    playback->setSpeed(as_frames_are_asked_for);
  }
  tells_reads_ = device_.isPropertySupported(openni2_property::images_read);
}

void OpenNi2Connection::start(openni::VideoStream& stream, openni::SensorType type,
                              const std::string& uri) {
  const std::string name = type == openni::SENSOR_DEPTH ? "depth" : "infrared";
  check(stream.create(device_, type), uri + ": its " + name + " stream cannot be opened");
  if (stream.getMirroringEnabled()) stream.setMirroringEnabled(false);
}

void OpenNi2Connection::record(const std::filesystem::path& oni_file) {
  oni_file_ = oni_file;
  check(recorder_.create(oni_file.c_str()), oni_file.string() + ": cannot be written");
  check(recorder_.attach(depth_), oni_file.string() + ": depth cannot be recorded");
  if (infrared_.isValid()) {
    check(recorder_.attach(infrared_), oni_file.string() + ": infrared cannot be recorded");
  }
  check(recorder_.start(), oni_file.string() + ": cannot be written");
  wait_while_growing(oni_file);
}

void OpenNi2Connection::end_recording() {
  wait_while_growing(oni_file_);
  recorder_.stop();
  recorder_.destroy();
}

std::optional<RawImage> OpenNi2Connection::wait_for_image(int timeout_ms) {
  openni::VideoStream* streams[] = {&depth_, &infrared_};
  const int stream_count = infrared_.isValid() ? 2 : 1;
  int ready = -1;
  const openni::Status status =
      openni::OpenNI::waitForAnyStream(streams, stream_count, &ready, timeout_ms);
  if (status == openni::STATUS_TIME_OUT) return std::nullopt;
  if (status != openni::STATUS_OK) {
    if (is_unplugged() || is_at_end()) return std::nullopt;
    throw InputError("waiting for images of " + listener_.uri + ": " + last_error());
  }
  return read(ready == 0 ? DeviceStream::range : DeviceStream::amplitude);
}

RawImage OpenNi2Connection::read(DeviceStream stream) {
  openni::VideoFrameRef frame;
  openni::VideoStream& source = stream == DeviceStream::range ? depth_ : infrared_;
  check(source.readFrame(&frame), "reading an image of " + listener_.uri);
  if (tells_reads_) device_.setProperty(openni2_property::images_read, 1);
  RawImage image;
  image.stream = stream;
  image.timestamp_us = static_cast<std::int64_t>(frame.getTimestamp());
  const openni::PixelFormat format = frame.getVideoMode().getPixelFormat();
  image.unit_m = unit_of(format);
  const bool is_known =
      stream == DeviceStream::range ? image.unit_m > 0 : format == openni::PIXEL_FORMAT_GRAY16;
  if (!is_known) {
    throw InputError(listener_.uri + ": its " +
                     (stream == DeviceStream::range ? "depth" : "infrared") +
                     " images have pixel format " + std::to_string(format) +
                     "; supported are 16-bit depth in mm or 0.1 mm, and 16-bit gray");
  }
  image.pixels.resize(frame.getHeight(), frame.getWidth());
  const auto* bytes = static_cast<const char*>(frame.getData());
  const auto row_bytes = static_cast<std::size_t>(frame.getWidth()) * sizeof(std::uint16_t);
  for (Eigen::Index row = 0; row < image.pixels.rows(); ++row) {
    std::memcpy(image.pixels.row(row).data(), bytes + row * frame.getStrideInBytes(), row_bytes);
  }
  return image;
}

bool OpenNi2Connection::waits_for_reader() const {
  float speed = 0;
  return device_.isPropertySupported(openni::DEVICE_PROPERTY_PLAYBACK_SPEED) &&
         device_.getProperty(openni::DEVICE_PROPERTY_PLAYBACK_SPEED, &speed) == openni::STATUS_OK &&
         speed == as_frames_are_asked_for;
}

std::vector<double> OpenNi2Connection::frequencies_hz() const {
  if (!device_.isPropertySupported(openni2_property::frequencies_hz)) return {};
  std::vector<double> values(most_frequencies);
  auto bytes = static_cast<int>(values.size() * sizeof(double));
  if (device_.getProperty(openni2_property::frequencies_hz, values.data(), &bytes) !=
      openni::STATUS_OK) {
    return {};
  }
  values.resize(static_cast<std::size_t>(bytes) / sizeof(double));
  return values;
}

}  // namespace tofmap

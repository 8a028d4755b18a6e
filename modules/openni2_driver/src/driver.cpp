// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "device_uri.hpp"
#include "oni_driver_api.hpp"
#include "played_device.hpp"

#include <cstdlib>
#include <cstring>
#include <list>
#include <mutex>
#include <sstream>
#include <string>

#include <tofmap/acquisition/openni2_properties.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Environment variable with URIs, separated by spaces, that the driver announces to programs which
/// list devices.
constexpr const char* announced_variable = "TOFMAP_DEVICES";

OniDeviceInfo info_of(const std::string& uri) {
  OniDeviceInfo info{};
  const auto copy = [](char* to, const std::string& text) {
    std::strncpy(to, text.c_str(), ONI_MAX_STR - 1);
  };
  copy(info.uri, uri);
  copy(info.vendor, "tofmap");
  copy(info.name, "multi-frequency time-of-flight camera");
  return info;
}

/// Offers scenes and recordings as OpenNI2 devices. Its functions do not throw, because OpenNI2
/// does not handle exceptions.
class Driver final : public oni::driver::DriverBase {
 public:
  explicit Driver(OniDriverServices* services) : DriverBase(services) {}

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback state_changed,
                       void* cookie) override {
    const OniStatus status = DriverBase::initialize(connected, disconnected, state_changed, cookie);
    const char* announced = std::getenv(announced_variable);
    std::istringstream uris(announced == nullptr ? "" : announced);
    for (std::string uri; status == ONI_STATUS_OK && uris >> uri;) tryDevice(uri.c_str());
    return status;
  }

  OniStatus tryDevice(const char* uri) override {
    try {
      parse_device_uri(uri);
    } catch (const UsageError& error) {
      if (std::string(uri).starts_with(uri_scheme)) refuse(error);
      return ONI_STATUS_ERROR;
    }
    const OniDeviceInfo info = info_of(uri);
    deviceConnected(&info);
    return ONI_STATUS_OK;
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char* /*mode*/) override {
    const OniDeviceInfo info = info_of(uri);
    PlayedDevice::Events events;
    events.at_end = [this, info] { deviceStateChanged(&info, ONI_DEVICE_STATE_EOF); };
    events.unplugged = [this, info] { deviceDisconnected(&info); };
    events.failed = [this, info](const char* what) {
      fail(what);
      deviceStateChanged(&info, ONI_DEVICE_STATE_ERROR);
    };
    try {
      const std::scoped_lock lock(mutex_);
      return &devices_.emplace_back(parse_device_uri(uri), events);
    } catch (const UsageError& error) {
      refuse(error);
    } catch (const std::exception& error) {
      fail(error.what());
    }
    return nullptr;
  }

  void deviceClose(oni::driver::DeviceBase* device) override {
    std::list<PlayedDevice> closed;
    const std::scoped_lock lock(mutex_);
    for (auto one = devices_.begin(); one != devices_.end(); ++one) {
      if (&*one != device) continue;
      closed.splice(closed.begin(), devices_, one);
      return;
    }
  }

  void shutdown() override {
    const std::scoped_lock lock(mutex_);
    devices_.clear();
  }

 private:
  void refuse(const UsageError& error) {
    getServices().errorLoggerAppend("%s%s", openni2_property::usage_error, error.what());
  }
  void fail(const char* what) { getServices().errorLoggerAppend("tofmap: %s", what); }

  std::mutex mutex_;
  std::list<PlayedDevice> devices_;
};

}  // namespace
}  // namespace tofmap

ONI_EXPORT_DRIVER(tofmap::Driver)

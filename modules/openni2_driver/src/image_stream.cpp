// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "image_stream.hpp"

#include "property_value.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <utility>

namespace tofmap {
namespace {

bool is_same(const OniVideoMode& one, const OniVideoMode& other) {
  return one.pixelFormat == other.pixelFormat && one.resolutionX == other.resolutionX &&
         one.resolutionY == other.resolutionY && one.fps == other.fps;
}

int stride_of(const OniVideoMode& mode) {
  return mode.resolutionX * static_cast<int>(sizeof(std::uint16_t));
}

}  // namespace

ImageStream::ImageStream(StreamDescription description, std::function<void()> on_change)
    : description_(std::move(description)),
      on_change_(std::move(on_change)),
      mode_(description_.modes.front()) {}

OniStatus ImageStream::start() {
  {
    const std::scoped_lock lock(mutex_);
    is_running_ = true;
  }
  on_change_();
  return ONI_STATUS_OK;
}

void ImageStream::stop() {
  {
    const std::scoped_lock lock(mutex_);
    is_running_ = false;
  }
  // A delivery may wait for a lock of OpenNI2 that the caller of stop() holds, so do not wait for
  // ever.
  constexpr std::chrono::seconds longest(1);
  { const std::unique_lock last_delivery(delivery_, longest); }
  on_change_();
}

bool ImageStream::is_running() const {
  const std::scoped_lock lock(mutex_);
  return is_running_;
}

OniVideoMode ImageStream::mode() const {
  const std::scoped_lock lock(mutex_);
  return mode_;
}

OniBool ImageStream::isPropertySupported(int id) {
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
    case ONI_STREAM_PROPERTY_STRIDE:
    case ONI_STREAM_PROPERTY_CROPPING:
    case ONI_STREAM_PROPERTY_MIRRORING:
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
    case ONI_STREAM_PROPERTY_MAX_VALUE:
    case ONI_STREAM_PROPERTY_MIN_VALUE:
      return TRUE;
    default:
      return FALSE;
  }
}

OniStatus ImageStream::getProperty(int id, void* data, int* size) {
  const OniVideoMode current = mode();
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
      return answer(current, data, size);
    case ONI_STREAM_PROPERTY_STRIDE:
      return answer(stride_of(current), data, size);
    case ONI_STREAM_PROPERTY_CROPPING:
      return answer(OniCropping{FALSE, 0, 0, current.resolutionX, current.resolutionY}, data, size);
    case ONI_STREAM_PROPERTY_MIRRORING:
      return answer(OniBool{FALSE}, data, size);
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      return answer(description_.horizontal_fov_rad, data, size);
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
      return answer(description_.vertical_fov_rad, data, size);
    case ONI_STREAM_PROPERTY_MAX_VALUE:
      return answer(int{std::numeric_limits<std::uint16_t>::max()}, data, size);
    case ONI_STREAM_PROPERTY_MIN_VALUE:
      return answer(0, data, size);
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus ImageStream::setProperty(int id, const void* data, int size) {
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE: {
      const auto* wanted = given<OniVideoMode>(data, size);
      if (wanted == nullptr) return ONI_STATUS_BAD_PARAMETER;
      const bool is_known = std::ranges::any_of(
          description_.modes, [&](const OniVideoMode& mode) { return is_same(mode, *wanted); });
      if (!is_known) return ONI_STATUS_BAD_PARAMETER;
      const std::scoped_lock lock(mutex_);
      if (is_running_ && !is_same(mode_, *wanted)) return ONI_STATUS_OUT_OF_FLOW;
      mode_ = *wanted;
      return ONI_STATUS_OK;
    }
    case ONI_STREAM_PROPERTY_CROPPING: {
      const auto* wanted = given<OniCropping>(data, size);
      if (wanted == nullptr) return ONI_STATUS_BAD_PARAMETER;
      return wanted->enabled ? ONI_STATUS_NOT_SUPPORTED : ONI_STATUS_OK;
    }
    case ONI_STREAM_PROPERTY_MIRRORING: {
      const auto* wanted = given<OniBool>(data, size);
      if (wanted == nullptr) return ONI_STATUS_BAD_PARAMETER;
      return *wanted ? ONI_STATUS_NOT_SUPPORTED : ONI_STATUS_OK;
    }
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

void ImageStream::deliver(const ImageU16& image, std::uint64_t timestamp_us, int index) {
  const std::scoped_lock lock(delivery_);
  if (!is_running()) return;
  const OniVideoMode current = mode();
  OniFrame* frame = getServices().acquireFrame();
  if (frame == nullptr) return;
  frame->sensorType = description_.type;
  frame->videoMode = current;
  frame->width = current.resolutionX;
  frame->height = current.resolutionY;
  frame->stride = stride_of(current);
  frame->croppingEnabled = FALSE;
  frame->cropOriginX = 0;
  frame->cropOriginY = 0;
  frame->timestamp = timestamp_us;
  frame->frameIndex = index;
  frame->dataSize = frame->stride * frame->height;
  std::memcpy(frame->data, image.data(), static_cast<std::size_t>(frame->dataSize));
  raiseNewFrame(frame);
  getServices().releaseFrame(frame);
}

}  // namespace tofmap

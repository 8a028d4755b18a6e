// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/queued_source.hpp"

#include <utility>

#include <tofmap/core/error.hpp>

namespace tofmap {

QueuedSource::QueuedSource(FrameSource& source, int capacity, LateFrames late_frames)
    : source_(source), capacity_(static_cast<std::size_t>(capacity)), late_frames_(late_frames) {
  if (capacity < 1) throw UsageError("a queue must hold at least one frame");
  thread_ = std::thread([this] { fetch(); });
}

QueuedSource::~QueuedSource() {
  {
    const std::scoped_lock lock(mutex_);
    is_closing_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void QueuedSource::fetch() {
  while (true) {
    std::optional<SourcedFrame> frame;
    std::exception_ptr failure;
    try {
      frame = source_.next();
    } catch (...) {
      failure = std::current_exception();
    }
    std::unique_lock lock(mutex_);
    if (frame && late_frames_ == LateFrames::block) {
      changed_.wait(lock, [this] { return frames_.size() < capacity_ || is_closing_; });
    }
    if (is_closing_) return;
    if (!frame) {
      failure_ = failure;
      has_ended_ = true;
    } else {
      if (frames_.size() == capacity_) {
        frames_.pop_front();
        ++dropped_;
      }
      frames_.push_back(std::move(*frame));
    }
    lock.unlock();
    changed_.notify_all();
    if (!frame) return;
  }
}

std::optional<SourcedFrame> QueuedSource::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !frames_.empty() || has_ended_; });
  if (frames_.empty()) {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::nullopt;
  }
  SourcedFrame frame = std::move(frames_.front());
  frames_.pop_front();
  lock.unlock();
  changed_.notify_all();
  return frame;
}

int QueuedSource::dropped() const {
  const std::scoped_lock lock(mutex_);
  return dropped_;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include <tofmap/acquisition/frame_source.hpp>

namespace tofmap {

/// What happens when a frame arrives and the queue is full.
enum class LateFrames : std::uint8_t {
  drop_oldest,  ///< the oldest frame of the queue is dropped: for cameras, which do not wait
  block,        ///< the source waits until there is room: for recordings
};

/// Fetches frames from a source in its own thread and keeps a limited number of them in a queue.
class QueuedSource final : public FrameSource {
 public:
  /// Starts the thread. `source` must outlive the queue, and no other code may call its next().
  /// `capacity` is the largest number of frames in the queue; throws UsageError if it is below 1.
  QueuedSource(FrameSource& source, int capacity, LateFrames late_frames);

  /// Waits until the source has returned its current frame.
  ~QueuedSource() override;

  const SensorModel& sensor() const override { return source_.sensor(); }

  /// Removes the oldest frame from the queue and returns it; waits for one if the queue is empty.
  /// Empty at the end of the source. An exception of the source is thrown here, after the frames
  /// that precede it.
  std::optional<SourcedFrame> next() override;

  std::optional<int> frame_count() const override { return source_.frame_count(); }

  /// Number of frames that were dropped because the queue was full.
  int dropped() const;

 private:
  void fetch();

  FrameSource& source_;
  std::size_t capacity_;
  LateFrames late_frames_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<SourcedFrame> frames_;
  std::exception_ptr failure_;
  int dropped_ = 0;
  bool has_ended_ = false;
  bool is_closing_ = false;
  std::thread thread_;  ///< declared last, because it uses all other members
};

}  // namespace tofmap

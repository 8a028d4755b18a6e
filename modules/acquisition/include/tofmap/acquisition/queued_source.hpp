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

/// What to do with a frame that arrives when the queue is full.
enum class LateFrames : std::uint8_t {
  drop_oldest,  ///< for cameras, which do not wait: the latest frames are the ones that matter
  block,        ///< for recordings: the source waits
};

/// Takes frames from a source in a thread of its own and keeps a bounded number of them until they
/// are asked for.
class QueuedSource final : public FrameSource {
 public:
  /// The source must outlive this, and nobody else may ask it. `capacity` must be above 0.
  QueuedSource(FrameSource& source, int capacity, LateFrames late_frames);

  /// Waits until the source has come back from its current frame.
  ~QueuedSource() override;

  const SensorModel& sensor() const override { return source_.sensor(); }

  /// The oldest frame that is kept; waits for one if there is none. What the source throws is
  /// thrown here, after the frames before it.
  std::optional<SourcedFrame> next() override;

  std::optional<int> frame_count() const override { return source_.frame_count(); }

  /// Frames that were dropped because nobody asked for them in time.
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
  std::thread thread_;  ///< last: it uses all the others
};

}  // namespace tofmap

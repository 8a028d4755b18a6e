// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/waiting.hpp>

#include <tofmap/acquisition/queued_source.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Counts from 0 to its end, and tells how far it was asked to.
class Counter final : public FrameSource {
 public:
  explicit Counter(int end) : end_(end) {}

  const SensorModel& sensor() const override { return sensor_; }
  std::optional<int> frame_count() const override { return end_; }
  std::optional<SourcedFrame> next() override {
    if (asked_ == throws_at) throw std::runtime_error("cable");
    if (asked_ == end_) return std::nullopt;
    SourcedFrame frame;
    frame.index = asked_++;
    return frame;
  }

  int asked() const { return asked_; }

  int throws_at = -1;

 private:
  SensorModel sensor_;
  int end_;
  std::atomic<int> asked_ = 0;
};

std::vector<int> all_of(QueuedSource& queue) {
  std::vector<int> indices;
  while (const auto frame = queue.next()) indices.push_back(frame->index);
  return indices;
}

TEST(QueuedSource, BlocksTheSourceAndLosesNothing) {
  Counter source(50);
  QueuedSource queue(source, 3, LateFrames::block);
  EXPECT_TRUE(
      test::comes_true([&] { return source.asked() == 4; }));  // three wait, and one is held
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(source.asked(), 4);
  const std::vector<int> indices = all_of(queue);
  ASSERT_EQ(indices.size(), 50U);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(indices[static_cast<std::size_t>(i)], i);
  EXPECT_EQ(queue.dropped(), 0);
}

TEST(QueuedSource, DropsTheOldestAndCountsThem) {
  Counter source(50);
  QueuedSource queue(source, 3, LateFrames::drop_oldest);
  EXPECT_TRUE(test::comes_true([&] { return source.asked() == 50 && queue.dropped() == 47; }));
  EXPECT_THAT(all_of(queue), testing::ElementsAre(47, 48, 49));
}

TEST(QueuedSource, HandsFailuresOnAfterTheFramesBeforeThem) {
  Counter source(50);
  source.throws_at = 2;
  QueuedSource queue(source, 8, LateFrames::block);
  EXPECT_EQ(queue.next()->index, 0);
  EXPECT_EQ(queue.next()->index, 1);
  EXPECT_THROW(queue.next(), std::runtime_error);
  EXPECT_FALSE(queue.next());
}

TEST(QueuedSource, CanBeGivenUpWhileTheSourceIsBlocked) {
  Counter source(50);
  {
    QueuedSource queue(source, 1, LateFrames::block);
    EXPECT_TRUE(test::comes_true([&] { return source.asked() == 2; }));
  }
  EXPECT_EQ(source.asked(), 2);
}

TEST(QueuedSource, NeedsRoomForAFrame) {
  Counter source(1);
  EXPECT_THROW(QueuedSource(source, 0, LateFrames::block), UsageError);
}

}  // namespace
}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/visualization/map_pictures.hpp>
#include <tofmap/visualization/window.hpp>

namespace tofmap::app {

/// A map as it grows, in a window. It has the thread that made it, since VTK wants one for all it
/// does; the work goes on in another.
class LiveView {
 public:
  /// Throws UsageError if there is no display.
  explicit LiveView(const std::string& title);

  /// Does some work in a thread of its own, and keeps the window going until it is done. What the
  /// work throws comes out here. Closing the window does not end the work.
  void accompany(const std::function<void()>& work);

  /// For the work to call as often as it likes: takes over the map so far when the window has shown
  /// the last one and a new one costs little of the time.
  void update(const MapRun& run, const std::string& status);

  /// Shows the finished map until the window is closed or the program interrupted.
  void show_result(const RoomMap& map);

 private:
  struct Snapshot {
    MapCloud surface;
    Trajectory trajectory;
    std::string status;
  };

  void show(const Snapshot& snapshot);
  void level(const Snapshot& snapshot);
  void handle_events();

  std::optional<Window> window_;  ///< until it is closed
  GravityAlignedFrame frame_;
  std::size_t levelled_points_ = 0;  ///< of the map for which the frame was found
  std::atomic<bool> is_open_ = true;

  std::mutex mutex_;
  std::optional<Snapshot> next_;  ///< guarded by mutex_; from the work, not shown yet
  std::chrono::steady_clock::time_point next_time_;  ///< the work's
};

/// Beside a window, if there is one.
void accompany(LiveView* view, const std::function<void()>& work);

}  // namespace tofmap::app

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

/// A window that shows a map as it grows. The window runs in the thread that created it, since all
/// calls of VTK must come from one thread; the mapping runs in another.
class LiveView {
 public:
  /// Opens the window. Throws UsageError if there is no display.
  explicit LiveView(const std::string& title);

  /// Runs `work` in another thread and handles the events of the window until it is done.
  /// Exceptions of `work` are passed on. Closing the window does not end the work.
  void accompany(const std::function<void()>& work);

  /// Offers the current map to the window. To be called by the work as often as it likes: the map
  /// is copied only if the window has shown the last copy, and at most 1/20 of the time is spent on
  /// copies.
  void update(const MapRun& run, const std::string& status);

  /// Shows the finished map until the window is closed or the user interrupts.
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

  std::optional<Window> window_;  ///< empty after it was closed
  GravityAlignedFrame frame_;
  std::size_t levelled_points_ = 0;  ///< size of the map when frame_ was estimated
  std::atomic<bool> is_open_ = true;

  std::mutex mutex_;
  std::optional<Snapshot> next_;  ///< guarded by mutex_; set by the work, not shown yet
  std::chrono::steady_clock::time_point next_time_;  ///< of the next copy; used by the work only
};

/// Runs `work` by LiveView::accompany, or in this thread if `view` is null.
void accompany(LiveView* view, const std::function<void()>& work);

}  // namespace tofmap::app

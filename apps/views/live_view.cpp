// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "views/live_view.hpp"

#include "console/interruption.hpp"

#include <future>
#include <thread>

#include <omp.h>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds screen_refresh(16);
constexpr std::chrono::milliseconds shortest_step(200);  ///< between snapshots
constexpr int most_share_of_time = 20;  ///< snapshots take at most 1/20 of the time of the work

constexpr const char* help =
    "left button: rotate, middle: pan, wheel: zoom, r: follow the map again, q: close";

}  // namespace

LiveView::LiveView(const std::string& title) {
  try {
    window_.emplace(title);
  } catch (const DrawingError& error) {
    throw UsageError(std::string(error.what()) + "; run without --view");
  }
  window_->set_text("waiting for frames", help);
  window_->on_key([this](const std::string& key) {
    if (key == "r") window_->look_from(viewpoint_outside(frame_.box_m));
  });
}

void LiveView::accompany(const std::function<void()>& work) {
  const int threads = omp_get_max_threads();
  std::future<void> done = std::async(std::launch::async, [&] {
    omp_set_num_threads(threads);  // OpenMP has a separate number for each thread
    work();
  });
  while (done.wait_for(screen_refresh) != std::future_status::ready) {
    std::optional<Snapshot> snapshot;
    {
      const std::scoped_lock lock(mutex_);
      snapshot.swap(next_);
    }
    if (snapshot) show(*snapshot);
    handle_events();
  }
  done.get();
}

void LiveView::update(const MapRun& run, const std::string& status) {
  const Clock::time_point start = Clock::now();
  if (!is_open_ || start < next_time_) return;
  {
    const std::scoped_lock lock(mutex_);
    if (next_) return;
  }
  const RoomMapper& mapper = run.mapper();
  const std::vector<int> maps = maps_of(mapper.content());
  Snapshot snapshot{{}, {}, status};
  if (!maps.empty()) {
    snapshot.surface = surface_of(mapper.content(), maps.front());
    snapshot.trajectory = trajectory_of(mapper.content(), maps.front());
  }
  const Clock::time_point end = Clock::now();
  next_time_ = end + std::max<Clock::duration>(shortest_step, most_share_of_time * (end - start));
  const std::scoped_lock lock(mutex_);
  next_ = std::move(snapshot);
}

void LiveView::show_result(const RoomMap& map) {
  if (!is_open_) return;
  levelled_points_ = 0;
  show({map.surface, map.trajectory, "finished"});
  while (is_open_ && !is_interrupted()) {
    handle_events();
    std::this_thread::sleep_for(screen_refresh);
  }
}

/// Updates the gravity-aligned frame. The alignment is estimated anew whenever the map has doubled
/// in size, since it is uncertain while the map is small, but not after the user has rotated the
/// view.
void LiveView::level(const Snapshot& snapshot) {
  if (window_->was_moved() || snapshot.surface.size() < 2 * levelled_points_) {
    frame_.box_m = gravity_aligned_box(snapshot.surface, frame_.aligned_from_map);
    return;
  }
  levelled_points_ = snapshot.surface.size();
  frame_ = gravity_aligned_frame(snapshot.surface, snapshot.trajectory);
}

void LiveView::show(const Snapshot& snapshot) {
  if (!window_ || snapshot.surface.empty()) return;
  level(snapshot);
  Drawing drawing = map_drawing(snapshot.surface, snapshot.trajectory, frame_);
  if (!snapshot.trajectory.empty()) {
    drawing.lines.push_back(camera_outline(Pose(frame_.aligned_from_map) *
                                           snapshot.trajectory.back().world_from_camera));
  }
  window_->show(drawing);
  window_->set_text(snapshot.status, help);
  if (!window_->was_moved()) window_->look_from(viewpoint_outside(frame_.box_m));
}

void LiveView::handle_events() {
  if (!window_ || window_->handle_events()) return;
  is_open_ = false;
  window_.reset();
}

void accompany(LiveView* view, const std::function<void()>& work) {
  view ? view->accompany(work) : work();
}

}  // namespace tofmap::app

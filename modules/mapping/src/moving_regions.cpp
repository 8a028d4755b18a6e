// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/moving_regions.hpp"

#include "cell_grid.hpp"
#include "keyframe_view.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tofmap {
namespace {

/// Errors of poses and ranges up to this are no motion.
constexpr double margin_m = 0.03;

/// A thing that moves is at most this far from where it was in the frame before.
constexpr double step_m = 0.2;
/// A thing is at most this far behind the place at which the latest keyframes saw it.
constexpr double step_since_keyframe_m = 0.3;

/// Number of frames without evidence of motion after which a thing is taken to stand still.
constexpr int frames_until_still = 15;

using CloudPointer = std::shared_ptr<const SurfaceCloud>;
using Observations = Cells<Observation>;

/// How a view relates to the cells of a cloud. A cell that the view sees through counts only if
/// both wrap counts are nearly certain.
Observations judge_cells(const CellGrid& grid, const Pose& world_from_camera,
                         const KeyframeView& view, const CellGrid& viewing,
                         const Pose& viewing_from_world, const CameraModel& camera) {
  Observations judged(grid.size(), Observation::nothing);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (!grid.has_surface(i)) continue;
    const Eigen::Vector3d world_m = world_from_camera * grid.point_m(i).cast<double>();
    judged[i] = view.judge(world_m);
    if (judged[i] != Observation::sees_through) continue;
    const auto behind = viewing.cell_at(project(camera, viewing_from_world * world_m));
    if (!grid.is_sure(i) || !behind || !viewing.is_sure(*behind)) judged[i] = Observation::nothing;
  }
  return judged;
}

/// A frame and a keyframe, compared both ways.
struct Comparison {
  Comparison() = default;

  Comparison(const CellGrid& frame, const RegistrationTarget& view,
             const RegistrationTarget& keyframe, const PoseSpread& spread,
             const CameraModel& camera)
      : grid(*keyframe.cloud, camera),
        of_frame(judge_cells(frame, view.world_from_camera,
                             KeyframeView(keyframe, camera, margin_m, spread), grid,
                             keyframe.world_from_camera.inverse(), camera)),
        of_keyframe(judge_cells(grid, keyframe.world_from_camera,
                                KeyframeView(view, camera, margin_m, spread), frame,
                                view.world_from_camera.inverse(), camera)) {}

  CellGrid grid;             ///< of the keyframe
  Observations of_frame;     ///< of the cells of the frame by the keyframe
  Observations of_keyframe;  ///< of the cells of the keyframe by the frame
};

/// What the keyframes say about the cells of a frame.
struct Evidence {
  explicit Evidence(const CellGrid& frame)
      : seeds(frame.size(), no_region), is_still(frame.size(), 0) {}

  Cells<int> seeds;      ///< `growing` where something moved since the keyframes, else `no_region`
  Cells<char> is_still;  ///< where a keyframe agrees and none sees through

  /// Whether there are more contradictions than agreements, apart from cells that are known to move
  /// (known_cells()): they cannot but contradict.
  bool is_of_wrong_pose(const Cells<int>& known) const {
    std::ptrdiff_t contradictions = 0;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      contradictions += seeds[i] == growing && known[i] == no_region ? 1 : 0;
    }
    return contradictions > std::ranges::count(is_still, 1);
  }
};

Evidence gather(const CellGrid& frame, const std::vector<Comparison>& comparisons) {
  Evidence evidence(frame);
  for (const Comparison& comparison : comparisons) {
    for (std::size_t i = 0; i < frame.size(); ++i) {
      if (comparison.of_frame[i] == Observation::sees_through) evidence.seeds[i] = growing;
      if (comparison.of_frame[i] == Observation::agrees) evidence.is_still[i] = 1;
    }
  }
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (evidence.seeds[i] != no_region) evidence.is_still[i] = 0;
  }
  return evidence;
}

/// Adds the cells of the frame that are just behind what has moved in a keyframe: the same thing, a
/// step further.
void add_steps(const Comparison& comparison, const Pose& frame_from_keyframe, const CellGrid& frame,
               const CameraModel& camera, Evidence& evidence) {
  for (std::size_t i = 0; i < comparison.grid.size(); ++i) {
    if (comparison.of_keyframe[i] != Observation::sees_through) continue;
    const Eigen::Vector3d point_m = frame_from_keyframe * comparison.grid.point_m(i).cast<double>();
    const auto cell = frame.cell_at(project(camera, point_m));
    if (!cell || !frame.has_surface(*cell) || evidence.is_still[*cell] != 0) continue;
    const double behind_m = frame.range_m(*cell) - point_m.norm();
    if (behind_m < step_since_keyframe_m) evidence.seeds[*cell] = growing;
  }
}

/// The keyframe without what the frame sees through and what is joined with that. Empty if there is
/// nothing of that kind.
std::optional<CleanedKeyframe> clean(const Keyframe& keyframe, const Comparison& comparison) {
  const std::size_t size = comparison.grid.size();
  Cells<int> seeds(size, no_region);
  Cells<char> is_still(size, 0);
  for (std::size_t i = 0; i < size; ++i) {
    if (comparison.of_keyframe[i] == Observation::sees_through) seeds[i] = growing;
    if (comparison.of_keyframe[i] == Observation::agrees) is_still[i] = 1;
  }
  const Cells<int> regions = grow_regions(comparison.grid, seeds, is_still);
  if (std::ranges::count(regions, growing) == 0) return std::nullopt;
  return CleanedKeyframe{keyframe.id,
                         without_regions(*keyframe.cloud.load(), comparison.grid, regions)};
}

/// For each cell of a frame, for how many frames what is there has shown no motion; `no_region` for
/// cells in which nothing is known to have moved.
Cells<int> known_cells(const std::vector<MovingPoint>& known, const CellGrid& frame,
                       const Pose& world_from_camera, const CameraModel& camera) {
  Cells<int> ages(frame.size(), no_region);
  const Pose camera_from_world = world_from_camera.inverse();
  for (const MovingPoint& point : known) {
    const Eigen::Vector3d point_m = camera_from_world * point.world_m;
    const auto cell = frame.cell_at(project(camera, point_m));
    if (!cell || !frame.has_surface(*cell)) continue;
    if (std::abs(frame.range_m(*cell) - point_m.norm()) > step_m) continue;
    int& age = ages[*cell];
    age = age == no_region ? point.age : std::min(age, point.age);
  }
  return ages;
}

bool has_region(const Cells<int>& regions) {
  return std::ranges::any_of(regions, [](int region) { return region != no_region; });
}

}  // namespace

CloudPointer MovingRegions::without_known(const CloudPointer& cloud,
                                          const Pose& world_from_camera) const {
  if (known_.empty()) return cloud;
  const CellGrid grid(*cloud, camera_);
  const Cells<int> regions = known_cells(known_, grid, world_from_camera, camera_);
  return has_region(regions) ? without_regions(*cloud, grid, regions) : cloud;
}

CloudPointer MovingRegions::background(const CloudPointer& cloud) const {
  const CellGrid grid(*cloud, camera_);
  const Cells<int> front = front_regions(grid);
  return has_region(front) ? without_regions(*cloud, grid, front) : cloud;
}

Motion MovingRegions::find(const CloudPointer& cloud, const Pose& world_from_camera,
                           std::span<const ComparedKeyframe> keyframes) const {
  Motion motion{.still = cloud, .keyframes = {}, .points = {}, .contradicts_pose = false};
  const CellGrid grid(*cloud, camera_);
  const RegistrationTarget view{cloud.get(), world_from_camera};
  std::vector<Comparison> comparisons(keyframes.size());
  std::vector<RegistrationTarget> targets;  // before the parallel loop, since loading may throw
  for (const ComparedKeyframe& compared : keyframes) {
    targets.push_back(target_of(*compared.keyframe));
  }
  const int count = static_cast<int>(keyframes.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    comparisons[at] = Comparison(grid, view, targets[at], keyframes[at].spread, camera_);
  }
  Evidence evidence = gather(grid, comparisons);
  const Cells<int> known = known_cells(known_, grid, world_from_camera, camera_);
  motion.contradicts_pose = evidence.is_of_wrong_pose(known);
  if (motion.contradicts_pose) return motion;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const Keyframe& keyframe = *keyframes[i].keyframe;
    if (auto cleaned = clean(keyframe, comparisons[i])) {
      motion.keyframes.push_back(std::move(*cleaned));
      add_steps(comparisons[i], world_from_camera.inverse() * keyframe.world_from_camera, grid,
                camera_, evidence);
    }
  }
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (evidence.seeds[i] == no_region && known[i] != no_region && known[i] < frames_until_still) {
      evidence.seeds[i] = known[i] + 1;
    }
  }
  const Cells<int> regions = grow_regions(grid, evidence.seeds, evidence.is_still);
  if (!has_region(regions)) return motion;
  motion.still = without_regions(*cloud, grid, regions);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (regions[i] == no_region) continue;
    motion.points.push_back({world_from_camera * grid.point_m(i).cast<double>(), regions[i]});
  }
  return motion;
}

void MovingRegions::remember(const Motion& motion) {
  if (!motion.contradicts_pose) {
    known_ = motion.points;
    return;
  }
  for (MovingPoint& point : known_) ++point.age;
  std::erase_if(known_, [](const MovingPoint& point) { return point.age >= frames_until_still; });
}

void MovingRegions::move(const Pose& new_from_old_world) {
  for (MovingPoint& point : known_) point.world_m = new_from_old_world * point.world_m;
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <memory>
#include <vector>

#include <tofmap/mapping/keyframe_graph.hpp>
#include <tofmap/mapping/loop_closure.hpp>
#include <tofmap/mapping/odometry.hpp>
#include <tofmap/mapping/relocalisation.hpp>
#include <tofmap/mapping/surface_map.hpp>

namespace boost::serialization {
class access;
}

namespace tofmap {

/// A place that was recognised.
struct Loop {
  int from_frame = 0;               ///< index of the earlier frame
  int to_frame = 0;                 ///< index of the later one
  double error_m = 0;               ///< by how much the path was off when the loop was found
  double mahalanobis_distance = 0;  ///< of the constraint from the final poses
  bool is_used = false;             ///< false: it disagrees with all others, and has lost its say
};

/// What a mapper needs to know of a frame.
struct NewFrame {
  int index = 0;
  double timestamp_s = 0;
  std::shared_ptr<const SurfaceCloud> cloud;  ///< camera frame; not null unless `repeats`
  bool repeats = false;                       ///< it has the phases of the frame before it
};

/// What became of a frame, and the wall-clock time that it took.
struct AddedFrame {
  TrackingResult tracking;
  double register_ms = 0;
  double integrate_ms = 0;
  double loop_ms = 0;
};

/// Follows the camera, recognises places, and keeps path and map consistent.
///
/// Every frame is registered by odometry against the keyframes around it, which where a place is
/// seen again are those of the first time. It belongs to the keyframe it overlaps most, and its
/// surface to the part of the map around that keyframe: so keyframes and map grow with what is
/// seen, not with time. Where a keyframe sees what one long before it saw, both are tied by an
/// edge, and the poses of all keyframes are fitted to the edges of odometry and loops. Parts and
/// frames move with their keyframes, so nothing is integrated anew.
///
/// A camera that has been lost for a few frames is looked for among all keyframes; after a second
/// or so only there. Frames in between are not registered.
class RoomMapper {
 public:
  RoomMapper(const CameraModel& camera, const OdometryOptions& odometry,
             const RegistrationOptions& registration, const LoopOptions& loops,
             const SurfaceMapOptions& surface);

  /// Registers a frame and, if that succeeds, adds its surface to the map, and looks for a loop if
  /// it becomes a keyframe. Frames come in the order of time.
  ///
  /// A frame that repeats the one before it says nothing new of the camera or the room: it is
  /// neither registered nor added (status `repeated`). Otherwise copies of one image would pass
  /// for independent observations of a point.
  AddedFrame add_frame(const NewFrame& frame);

  /// Fits the poses to edges that were not fitted yet; to be called after the last frame.
  void finish();

  Trajectory trajectory() const;  ///< every frame that was registered, as it is believed now
  Trajectory keyframe_trajectory() const;
  MapCloud surface() const;
  std::size_t voxel_count() const;  ///< those with too few points to be written among them
  const std::vector<Loop>& loops() const { return loops_; }

  /// Puts all that was found out aside, to go on from there later: a mapper that was made with the
  /// same options and loads it gives the same results to the bit. Only the build that wrote it can
  /// read it. Reading throws std::exception if it is damaged.
  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  friend class boost::serialization::access;
  template <class Archive>
  void serialize(Archive& archive, unsigned version);  // mapper_archive.cpp

  struct RegisteredFrame {
    double timestamp_s = 0;
    int keyframe = 0;
    Pose keyframe_from_camera = Pose::Identity();

    template <class Archive>
    void serialize(Archive& archive, unsigned version);
  };

  /// What frames saw from near by one keyframe, its anchor, in that one's frame.
  struct Part {
    int anchor = 0;
    SurfaceMap surface;
  };

  TrackingResult track(const NewFrame& frame);
  void integrate(const SurfaceCloud& cloud);
  void close_loops();
  TrackingResult find_camera(double timestamp_s, const SurfaceCloud& cloud,
                             std::span<const Keyframe* const> around);
  TrackingResult relocalised(double timestamp_s, const SurfaceCloud& cloud);
  KeyframeSpacing keyframe_spacing() const;
  std::vector<const Keyframe*> keyframes_around() const;
  bool wants_keyframe(const Pose& pose, std::span<const Keyframe* const> around) const;
  void add_keyframe(const NewFrame& frame, std::span<const Keyframe* const> around,
                    const TrackingResult& result);
  int part_for(int id, const Pose& pose, std::span<const Keyframe* const> around);
  void fit();

  CameraModel camera_;
  OdometryOptions odometry_options_;
  RegistrationOptions registration_;
  LoopOptions loop_options_;
  SurfaceMapOptions surface_options_;
  Odometry odometry_;
  KeyframeGraph keyframes_;
  std::vector<Part> parts_;
  std::vector<int> part_of_;  ///< index of the part that a keyframe's frames go to
  std::vector<RegisteredFrame> frames_;
  std::vector<PoseEdge> edges_;
  std::vector<Loop> loops_;  ///< in the order of their edges
  int unfitted_loops_ = 0;
  int last_fit_ = 0;     ///< keyframe
  int current_ = 0;      ///< keyframe that frames belong to
  int lost_frames_ = 0;  ///< since the last that was registered
  int searched_ = 0;     ///< keyframes for which loops were looked for
};

}  // namespace tofmap

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
  int from_frame = 0;     ///< index of the earlier frame
  int to_frame = 0;       ///< index of the later one
  double error_m = 0;     ///< by how much the path was off when the loop was found
  double deviations = 0;  ///< how far the edge is off in the end, in standard deviations
  bool is_used = false;   ///< false: it disagrees with all others, and has lost its say
};

/// Follows the camera, recognises places, and keeps path and map consistent.
///
/// Every frame is placed by odometry against the keyframes around it, which where a place is seen
/// again are those of the first time. It belongs to the keyframe it overlaps most, and its surface
/// to the part of the map around that keyframe: so keyframes and map grow with what is seen, not
/// with time.
/// Where a keyframe sees what one long before it saw, both are tied by an edge, and the poses of
/// all keyframes are fitted to the edges of odometry and loops. Parts and frames move with their
/// keyframes, so nothing is integrated anew.
///
/// A camera that has been lost for a few frames is looked for among all keyframes; after a second
/// or so only there. Frames in between are not placed.
class RoomMapper {
 public:
  RoomMapper(const CameraModel& camera, const OdometryOptions& odometry,
             const RegistrationOptions& registration, const LoopOptions& loops,
             const SurfaceMapOptions& surface);

  /// Finds out where a frame was taken. Frames come in the order of time. If the frame was placed,
  /// integrate() and close_loops() are to follow.
  TrackingResult track(int frame_index, double timestamp_s,
                       const std::shared_ptr<const SurfaceCloud>& cloud);

  /// Adds the surface of the frame that was placed last.
  void integrate(const SurfaceCloud& cloud);

  /// If that frame is a keyframe, looks whether its place was seen before, and now and then fits
  /// the poses to all edges.
  void close_loops();

  /// Fits the poses to edges that were not fitted yet; to be called after the last frame.
  void finish();

  Trajectory trajectory() const;  ///< every frame that was placed, as it is believed now
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

  struct PlacedFrame {
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

  TrackingResult find_camera(double timestamp_s, const SurfaceCloud& cloud,
                             std::span<const Keyframe* const> around);
  TrackingResult relocalised(double timestamp_s, const SurfaceCloud& cloud);
  KeyframeSteps keyframe_steps() const;
  std::vector<const Keyframe*> keyframes_around() const;
  bool wants_keyframe(const Pose& pose, std::span<const Keyframe* const> around) const;
  void add_keyframe(int frame_index, double timestamp_s,
                    const std::shared_ptr<const SurfaceCloud>& cloud,
                    std::span<const Keyframe* const> around, const TrackingResult& result);
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
  std::vector<PlacedFrame> frames_;
  std::vector<PoseEdge> edges_;
  std::vector<Loop> loops_;  ///< in the order of their edges
  int unfitted_loops_ = 0;
  int last_fit_ = 0;     ///< keyframe
  int current_ = 0;      ///< keyframe that frames belong to
  int lost_frames_ = 0;  ///< since the last that was placed
  int searched_ = 0;     ///< keyframes for which loops were looked for
};

}  // namespace tofmap

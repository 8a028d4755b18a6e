// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/mapping/frame_constraint.hpp>
#include <tofmap/mapping/keyframe_graph.hpp>
#include <tofmap/mapping/map_change.hpp>
#include <tofmap/mapping/submap.hpp>
#include <tofmap/mapping/surface_map.hpp>
#include <tofmap/registration/path_uncertainty.hpp>
#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {

/// A loop: a place that was recognised.
struct Loop {
  int from_frame = 0;               ///< index of the frame of the earlier keyframe
  int to_frame = 0;                 ///< index of the frame of the later keyframe
  double error_m = 0;               ///< error of the path in position when the loop was found
  double mahalanobis_distance = 0;  ///< of the loop constraint at the poses of the last fit
  bool is_used = false;  ///< whether the last fit accepted it; false before the first fit
};

/// How certain the pose of a frame is.
struct PoseCertainty {
  int frame = 0;        ///< index of the frame
  ExpectedError error;  ///< after the best rigid alignment of all keyframes of the map
};

/// A frame whose pose in a map is known.
struct RegisteredFrame {
  double timestamp_s = 0;
  int keyframe = 0;  ///< id of the keyframe that the frame belongs to
  Pose keyframe_from_camera = Pose::Identity();
  int index = 0;      ///< of the frame in its recording
  int recording = 0;  ///< index in MapContent::recordings
  /// This is the covariance of the error of the pose relative to all keyframes that it was
  /// registered with: rotation vector in radians, then translation in metres, along the axes of
  /// `keyframe`. It is zero for the frame of the keyframe itself, and by the surfaces alone until
  /// smooth_path() adds the motion.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// What the registrations with keyframes tell, one for each of them. Those with keyframes beyond
  /// a slip or in another map are removed, and so are all of a frame that was registered again. The
  /// first frame of a map has none, nor have frames of maps in version 1 of the format.
  std::vector<FrameConstraint> constraints = {};
};

/// A recording that a map was made from.
struct MapRecording {
  std::string source;   ///< what was mapped, as it was given to the program
  std::string added;    ///< when mapping it began: UTC, ISO 8601, for instance 2026-11-29T08:30:00Z
  std::string version;  ///< of the program
  std::string options;  ///< of all stages, as YAML
  SensorModel sensor;
  std::string verdict = {};  ///< on the map after this recording (Verdict); empty: not judged
};

/// What a map consists of: all that registration, loop closure and the surface need. Keyframes of
/// different `Keyframe::map` are in different world frames.
struct MapContent {
  MapContent(const CameraModel& camera, const SurfaceMapOptions& options);

  CameraModel camera;  ///< of all recordings
  SurfaceMapOptions surface_options;
  std::vector<MapRecording> recordings;  ///< in the order of time
  KeyframeGraph keyframes;
  std::vector<Submap> submaps;
  std::vector<int> submap_of;  ///< for each keyframe, the index of the submap of its frames
  std::vector<RegisteredFrame> frames;
  std::vector<PoseEdge> edges;  ///< of odometry and of loops, between keyframes by their ids
  std::vector<Loop> loops;      ///< in the order of their edges
  /// What recordings show to have changed: find_changes() at the end of the last recording.
  std::vector<MapChange> changes;
};

/// Whether two cameras are the same, up to a thousandth. Only then can frames of one be registered
/// with keyframes of the other.
bool are_same_camera(const CameraModel& one, const CameraModel& other);

/// The map that has the most keyframes (Keyframe::map). 0 if there are none.
int largest_map(const MapContent& content);

/// Index of the submap that the latest frame belongs to. Empty without frames.
std::optional<std::size_t> latest_submap(const MapContent& content);

/// Indices of the submaps in memory that the next frame will hardly change: of all but the latest.
std::vector<int> submaps_at_rest(const MapContent& content);

/// The pose of a frame in the world of its map.
Pose pose_of(const RegisteredFrame& frame, const KeyframeGraph& keyframes);

/// Whether two maps have a recording in common: one whose first keyframes are of the same frame and
/// look the same to the bit, which noise does not allow otherwise.
bool have_one_recording(const MapContent& one, const MapContent& other);

/// The earlier recording of a map that the last one repeats, by the same rule. Empty if it repeats
/// none.
std::optional<int> repeated_recording(const MapContent& content);

/// The numbers of the maps in which frames of the last recording are registered: first those of
/// earlier recordings that they extend, then the others, each time that with the most of these
/// frames first. Empty if there are none.
std::vector<int> maps_of(const MapContent& content);

/// The frames of the last recording that are registered in maps of earlier ones, in order. The
/// pointers are valid until `content` changes.
std::vector<const RegisteredFrame*> localised_frames_of(const MapContent& content);

/// Poses of the frames of a recording that are registered in a map, from the current poses of their
/// keyframes.
Trajectory trajectory_of(const MapContent& content, int map, int recording);

/// The same of the last recording.
Trajectory trajectory_of(const MapContent& content, int map);

/// Indices (RegisteredFrame::index) of the frames of the last recording that are registered in a
/// map, in the order of trajectory_of().
std::vector<int> frames_of(const MapContent& content, int map);

/// Current poses of the keyframes of the last recording that belong to a map.
Trajectory keyframe_trajectory_of(const MapContent& content, int map);

/// Current poses of all keyframes of a map.
Trajectory all_keyframes_of(const MapContent& content, int map);

/// How certain the frames of the last recording in a map are, in the order of trajectory_of(): the
/// pose of a keyframe is as certain as the covariances of the edges of odometry and of the loops
/// that are used say (expected_errors()), and the position of a frame relative to it as when the
/// frame was registered.
std::vector<PoseCertainty> certainties_of(const MapContent& content, int map);

/// The frame whose position is least certain. There must be one.
PoseCertainty least_certain(std::span<const PoseCertainty> frames);

/// The covariances of the errors of the poses of trajectory_of() in the world of the map, if its
/// keyframes of earlier recordings are exact: rotation vector in radians, then translation in
/// metres, along the axes of the world. Of the first recording, relative to the first keyframe.
std::vector<Eigen::Matrix<double, 6, 6>> covariances_of(const MapContent& content, int map);

/// The surface of the submaps whose anchors are wanted, in the world frame. The anchors must be of
/// one map.
MapCloud merged_submaps(const MapContent& content,
                        const std::function<bool(const Keyframe& anchor)>& is_wanted);

/// The surface of a map: all of its submaps in its world frame, without free-space violations if
/// the options say so.
MapCloud surface_of(const MapContent& content, int map);

/// Number of voxels in all submaps, including those with too few points for surface_of().
std::size_t voxel_count(const MapContent& content);

}  // namespace tofmap

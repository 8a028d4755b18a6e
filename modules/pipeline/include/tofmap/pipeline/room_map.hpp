// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/diagnostics/absence.hpp>
#include <tofmap/diagnostics/consistency.hpp>
#include <tofmap/diagnostics/error_survey.hpp>
#include <tofmap/diagnostics/map_verdict.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {

struct PipelineOptions;

/// Wall-clock time that each stage took for one frame, milliseconds.
struct StageTimes {
  double unwrap_ms = 0;    ///< measuring noise and errors, and unwrapping
  double filter_ms = 0;    ///< filters
  double cloud_ms = 0;     ///< points and normals
  double register_ms = 0;  ///< registration with keyframes
  double map_ms = 0;       ///< integration into the map
  double loop_ms = 0;      ///< search for loops, and the pose graph

  double total_ms() const {
    return unwrap_ms + filter_ms + cloud_ms + register_ms + map_ms + loop_ms;
  }
};

/// The stages in order, by the names that reports and map files have for them, and their times.
inline constexpr std::array<std::pair<const char*, double StageTimes::*>, 6> stage_times{
    {{"unwrap", &StageTimes::unwrap_ms},
     {"filter", &StageTimes::filter_ms},
     {"cloud", &StageTimes::cloud_ms},
     {"register", &StageTimes::register_ms},
     {"map", &StageTimes::map_ms},
     {"loops", &StageTimes::loop_ms}}};

/// What is kept of the tracking of each frame (TrackingResult).
struct FrameTracking {
  TrackingStatus status = TrackingStatus::lost;
  bool is_keyframe = false;
  RegistrationFigures registration;  ///< all defaults if registration was not tried

  /// Whether the pose of the frame was found.
  bool registered() const { return is_registered(status); }
};

/// The result of processing one frame.
struct FrameRecord {
  int index = 0;
  double timestamp_s = 0;
  /// Why the frame could not be read; empty if it could. If it is not empty, only `damage`,
  /// `index`, `timestamp_s` and `map` have a meaning.
  std::string damage;
  /// The frame has the same phases as the frame before it, and was therefore not unwrapped. Then
  /// only `index`, `timestamp_s`, `map` and the status in `tracking` have a meaning.
  bool repeats = false;
  int iterations = 0;             ///< UnwrapResult::iterations
  int curl_violations = 0;        ///< UnwrapResult::curl_violations
  double phase_noise_cycles = 0;  ///< UnwrapResult::phase_noise_cycles
  int valid_pixels = 0;           ///< valid pixels after unwrapping
  int kept_pixels = 0;            ///< valid pixels after filtering
  std::vector<FilterCount> filters;
  FrameTracking tracking;
  StageTimes times;
  /// The map that the frame is registered in: 1 is the main map, k + 2 is separate_maps[k]. 0:
  /// none, or the run is not finished.
  int map = 0;

  /// Whether the frame was unwrapped, filtered and tracked: it is neither damaged nor repeated.
  bool is_prepared() const { return damage.empty() && !repeats; }
};

/// Why a frame of a finished run is in no map. Empty if it is in one.
std::optional<Absence> absence_of(const FrameRecord& record);

/// A map that could not be joined with the others of its recording, because none of their places
/// was recognised with certainty. World coordinates are those of its first camera.
struct SeparateMap {
  Trajectory trajectory;  ///< world_from_camera of every frame registered in it
  Trajectory keyframes;   ///< world_from_camera of the keyframes
  MapCloud surface;
};

/// A map of a room, with the records of all frames. World coordinates are those of its first
/// camera. If tracking was lost and the maps before and after could not be joined, it is the map
/// with the most frames.
struct RoomMap {
  Trajectory trajectory;                   ///< world_from_camera of every registered frame
  Trajectory keyframes;                    ///< world_from_camera of the keyframes
  MapCloud surface;                        ///< in world coordinates
  std::vector<SeparateMap> separate_maps;  ///< the other maps, that with the most frames first
  std::vector<Loop> loops;                 ///< all loops that were found, used or not
  int contradicted_loops = 0;              ///< number of those that tell against the map
  int joins = 0;                           ///< of maps within the recording (RoomMapper::joins())
  int blind_joins = 0;                     ///< RoomMapper::blind_joins()
  int joins_taken_back = 0;                ///< RoomMapper::joins_taken_back()
  PoseCertainty least_certain;             ///< of all frames; zero without keyframes
  int uncertain = 0;                       ///< frames less certain than most_position_sigma_m
  int registered_slowly = 0;               ///< number of frames that converged_slowly()
  /// Number of frames that were found in the map of earlier recordings (MapRun::go_on_with()).
  /// Empty if there were none.
  std::optional<int> localised;
  MapNearness nearness;            ///< RoomMapper::nearness()
  std::vector<MapChange> changes;  ///< those of the map, by all recordings; see find_changes()
  /// Whether the recording has moved the map that it extends, by loops that are used.
  bool has_moved_map = false;
  std::vector<FrameRecord> frames;  ///< all frames, in order
  ErrorSurvey errors;               ///< MapRun::errors at the end of the run
  bool interrupted = false;         ///< a hook ended the run early

  int damaged() const;     ///< number of frames that could not be read
  int repeated() const;    ///< number of frames that repeat the frame before them
  int degenerate() const;  ///< number of frames with a degenerate direction of motion
  int separate() const;    ///< number of frames that are registered in separate maps
  /// Indices of the frames that are registered in a map (FrameRecord::map), in order.
  std::vector<int> frames_in(int number) const;
};

/// Whether nearly all frames are registered in one map, few of them slowly, and do not contradict
/// each other, as far as its consistency measures can tell. Then wrap counts are right, apart from
/// few.
bool frames_agree(const RoomMap& map, const Consistency& consistency);

/// How many frames are in no map, and why.
MissingFrames missing_frames(const RoomMap& map);

/// The evidence for the verdict on a map without ground truth. `warnings` are those about the
/// recording and the map.
MapEvidence evidence_of(const RoomMap& map, const PipelineOptions& options,
                        const Consistency& consistency, const std::vector<std::string>& warnings);

/// Throws InputError if more than half of the frames are damaged. The message quotes
/// `first_damage`.
void refuse_mostly_damaged(int damaged, int total, const std::string& first_damage);
void refuse_mostly_damaged(const RoomMap& map);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include <tofmap/mapping/camera_travel.hpp>
#include <tofmap/mapping/join_choice.hpp>
#include <tofmap/mapping/join_evidence.hpp>
#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/mapping/map_content.hpp>
#include <tofmap/mapping/map_join.hpp>
#include <tofmap/mapping/mapper_state.hpp>
#include <tofmap/mapping/place_recognition.hpp>
#include <tofmap/mapping/still_odometry.hpp>
#include <tofmap/mapping/surface_map.hpp>

namespace tofmap {

struct Slip;

/// Input of RoomMapper::add_frame().
struct NewFrame {
  int index = 0;  ///< of the frame in the recording
  double timestamp_s = 0;
  std::shared_ptr<const SurfaceCloud> cloud;  ///< in the camera's frame; not null unless `repeats`
  bool repeats = false;                       ///< whether it has the phases of the frame before it
};

/// A frame whose result has changed after it was added: it was registered later, or its map was
/// dropped.
struct LateFrame {
  int index = 0;  ///< NewFrame::index
  TrackingResult tracking;
  std::shared_ptr<const SurfaceCloud> still;  ///< as AddedFrame::still
};

/// What became of a frame, and the wall-clock times of the steps.
struct AddedFrame {
  TrackingResult tracking;
  std::vector<LateFrame> late;  ///< frames before it whose result has changed
  /// The cloud as it may enter the map (StillTracking::still); NewFrame::cloud itself if nothing is
  /// left out.
  std::shared_ptr<const SurfaceCloud> still;
  double register_ms = 0;   ///< tracking or relocalisation
  double integrate_ms = 0;  ///< adding the surface to the map
  double loop_ms = 0;       ///< loop search and pose graph
};

/// What a recording does with a finished map.
enum class MapUse {
  extend,    ///< goes on with it: adds its surface, and corrects poses by new loops
  localise,  ///< is localised in it: the poses of its keyframes are held
};

/// A place in a finished map.
struct MapPlace {
  int map = 0;  ///< Keyframe::map
  Pose world_from_camera = Pose::Identity();
  bool has_rotation = true;  ///< false if only the position is known
};

/// How near a recording came to being found in a map.
struct MapNearness {
  int keyframes = 0;   ///< number of keyframes that were compared with the map
  int recognised = 0;  ///< number of those that may see a place of it
  int agreeing = 0;    ///< number of those that agree on the likeliest place
  JoinObstacle obstacle = JoinObstacle::too_few;
};

/// Tracks the camera, closes loops, and keeps trajectory and map consistent.
///
/// Odometry registers each frame with the keyframes around it. At a place that is seen again,
/// these are the keyframes of the first visit. A frame belongs to the keyframe of its own map
/// that it overlaps most, and its surface to the submap around that keyframe. Thus the number
/// of keyframes and the size of the map grow with the surface seen, not with time, as long as
/// tracking is not lost. A loop constraint connects a keyframe with a much earlier one that saw
/// the same place, and the pose graph fits the poses of all keyframes to the edges of odometry
/// and loops. Submaps and frames move with their keyframes, so no frame is integrated again.
///
/// When tracking is lost, or after more than two seconds without registered frames, a new map
/// begins: once three frames with a surface could not be registered, the first of them is the
/// origin of a map of its own, and the others are tracked in it. Every keyframe of the newest map
/// is compared with those of the other maps that the camera can have reached in the time since then
/// (can_travel()); when three keyframes recognise places of another map and agree, both maps are
/// joined; for a map of earlier recordings, see choose_join(). Others stay separate. The keyframes
/// and submaps of a map stay apart from those of the maps that it was joined with, so that the join
/// can be taken back: when two later keyframes differ from what the other map has there, when a
/// frame fits only its own map and contradicts the other, or when later keyframes show that another
/// place of a map of earlier recordings fits clearly better (review_join()). A map of fewer than
/// three frames is dropped again when the next one begins.
///
/// People, doors and other things that move are found (StillOdometry); they have no part in
/// registration, keyframes and surface.
class RoomMapper {
 public:
  RoomMapper(const CameraModel& camera, const OdometryOptions& odometry,
             const RegistrationOptions& registration, const LoopOptions& loops,
             const SurfaceMapOptions& surface);

  /// Says what the frames come from. Without this, content().recordings says nothing of it.
  void describe_recording(MapRecording recording);

  /// Says how good the map is after the recording (MapRecording::verdict).
  void note_verdict(const std::string& verdict) { content_.recordings.back().verdict = verdict; }

  /// Goes on with a finished map: the frames that follow are those of another recording of the same
  /// place. They begin a map of their own, which is joined with the finished one as soon as its
  /// places are recognised. `recording` describes them. `start` is where the camera is at the first
  /// frame, if that is known to half a metre and 45 degrees; otherwise it may be anywhere. Must be
  /// called before the first frame.
  void go_on_with(MapContent finished, MapRecording recording, MapUse use,
                  std::optional<MapPlace> start = std::nullopt);

  /// How near the frames came to being found in the finished map.
  const MapNearness& nearness() const { return nearness_; }

  /// Number of localised_frames_of() the map so far.
  int localised_frames() const { return static_cast<int>(localised_frames_of(content_).size()); }

  /// Registers a frame. If that succeeds, adds its surface to the map and, if it becomes a
  /// keyframe, searches for a loop. Frames must come in the order of time.
  ///
  /// A frame that repeats the one before it is neither registered nor added (status `repeated`).
  /// Otherwise copies of one image would count as independent observations of its points.
  AddedFrame add_frame(const NewFrame& frame);

  /// Joins maps of the recording with the finished one that share too little with it to be joined
  /// on the way (find_certain_join()), fits the pose graph if it has loop constraints that were not
  /// fitted yet, and finds what has changed between recordings. Must be called after the last
  /// frame.
  void finish();

  /// The map so far. Keyframes and what refers to them may still move.
  const MapContent& content() const { return content_; }
  /// How often maps were joined although the camera could have been carried to another place: it
  /// had not been tracked for more than two seconds.
  int blind_joins() const;
  /// Number of joins of maps that were not taken back, including blind_joins().
  int joins() const { return static_cast<int>(joins_.size()); }
  /// Number of joins that were taken back.
  int joins_taken_back() const { return joins_taken_back_; }
  /// What the mapper knows besides content().
  MapperState state() const;

  /// Replaces the state by one that state() returned together with `content`. A mapper that was
  /// constructed with the same arguments then gives the same results to the bit. `frames` is the
  /// number of frames that the recording has had. Throws InputError if the state is damaged or does
  /// not fit the content; the mapper is then not to be used.
  void restore(MapContent content, const MapperState& state, int frames);

 private:
  /// Two maps that were joined.
  struct JoinedMaps {
    int map = 0;            ///< the one whose keyframes were moved
    int into = 0;           ///< the one that they belong to since
    int found_in = 0;       ///< the map whose keyframes recognised it; Keyframe::taken_in
    bool is_blind = false;  ///< see blind_joins()
  };

  /// Smallest number of keyframes between two fits, unless a loop still awaits others that agree
  /// with it, and largest number of keyframes that it waits for. Loops mostly come one after the
  /// other, and are fitted together.
  static constexpr int keyframes_between_fits = 10;

  std::span<const RegisteredFrame> own_frames() const;
  bool is_of_another_place(const RegistrationTarget& frame, const Keyframe& other) const;
  TrackingResult track(NewFrame& frame);
  bool was_blind(double timestamp_s) const;
  StillTracking track_with(std::span<const Keyframe* const> around, NewFrame& frame);
  std::vector<LateFrame> start_map();
  std::vector<LateFrame> drop_fragment();
  void integrate(const SurfaceCloud& cloud);
  void close_loops();
  void recognise_place();
  bool agrees_with_start(const MapJoin& join, std::span<const Keyframe> keyframes) const;
  IsPossibleJoin possible_after(std::span<const Stretch> travelled,
                                std::span<const Keyframe> keyframes) const;
  std::vector<Stretch> stretches(std::span<const Keyframe> keyframes) const;
  void recognise_among(const Keyframe& keyframe, std::vector<const Keyframe*> candidates,
                       const IsPossiblePlace& is_possible);
  std::optional<MapJoin> found_join(std::span<const Stretch> travelled);
  void join_maps(std::span<const Stretch> travelled);
  void join(const MapJoin& join, std::span<const Stretch> travelled);
  void join_afterwards();
  JoinEvidence evidence_of(const MapJoin& join) const;
  bool refutes_join(const JoinEvidence& evidence, int into) const;
  std::optional<bool> differs_from_others(const Keyframe& keyframe) const;
  TrackingResult track_apart(NewFrame& frame, std::span<const Keyframe* const> around);
  std::optional<StillTracking> track_undisturbed(NewFrame& frame,
                                                 std::span<const Keyframe* const> around,
                                                 const StillTracking& disturbed,
                                                 const StillOdometry& before);
  bool is_of_earlier_recording(int map) const;
  void check_join();
  void review_join_of_newest(bool at_the_end);
  void refute_join();
  void take_join_back();
  void connect_own_keyframes();
  void drop_edges_between_maps();
  void return_to_origin(int map);
  std::size_t held_keyframes() const;
  int recording() const { return static_cast<int>(content_.recordings.size()) - 1; }
  int newest_map() const { return begun_maps_ - 1; }
  bool is_joined() const { return map_ != newest_map(); }
  /// Whether the keyframes of an edge are in different maps.
  bool connects_maps(const PoseEdge& edge) const {
    return content_.keyframes[edge.from].map != content_.keyframes[edge.to].map;
  }
  bool is_own(const Keyframe& keyframe) const { return keyframe.taken_in == newest_map(); }
  std::vector<const Keyframe*> own(std::span<const Keyframe* const> keyframes) const;
  const Keyframe* keyframe_near(const Pose& pose, int map) const;
  std::optional<Slip> slip_behind(const PoseEdge& loop);
  void mend(const Slip& slip);
  void add_loop(const PoseEdge& edge);
  bool loop_awaits_others() const;
  KeyframeSpacing keyframe_spacing() const;
  std::vector<const Keyframe*> keyframes_around() const;
  bool wants_keyframe(const TrackingResult& result, std::span<const Keyframe* const> around) const;
  void add_keyframe(const NewFrame& frame, std::span<const Keyframe* const> around,
                    const TrackingResult& result);
  int submap_for(int id, const Pose& pose, std::span<const Keyframe* const> around);
  void follow_keyframe(const Pose& before);
  void mend_slips();
  void separate_submaps(int at);
  void rebuild_submaps(const std::set<int>& submaps);
  void mend_uncertain_starts();
  void close_loops_of(std::span<const int> keyframes);
  void fit();

  CameraModel camera_;
  OdometryOptions odometry_options_;
  RegistrationOptions registration_;
  LoopOptions loop_options_;
  StillOdometry odometry_;
  MapContent content_;
  MapUse use_ = MapUse::extend;
  std::optional<MapPlace> start_;
  MapNearness nearness_;
  int unfitted_loops_ = 0;
  int waiting_loop_ = -1;  ///< later keyframe of the newest loop that awaits others; −1: none
  int last_fit_ = 0;       ///< id of the newest keyframe in the last fit
  /// Id of the newest keyframe at the last search for a slip that found none.
  int last_slip_search_ = -keyframes_between_fits;
  int current_ = 0;             ///< id of the keyframe that the latest frame belongs to
  int map_ = 0;                 ///< the map that frames are added to
  int begun_maps_ = 1;          ///< number of maps so far, with those that were joined or dropped
  int lost_frames_ = 0;         ///< number of frames since the last registered one
  int searched_ = 0;            ///< number of keyframes for which loops were searched
  std::vector<NewFrame> held_;  ///< frames with a surface since the last registered one
  std::vector<JoinedMaps> joins_;  ///< those not taken back, in order
  JoinEvidence evidence_;          ///< about the join of the newest map
  int joins_taken_back_ = 0;
  std::vector<PoseEdge> recognitions_;  ///< from a keyframe of another map to one of `map_`
  /// All places of earlier recordings that keyframes of maps not joined yet may see.
  std::vector<PoseEdge> possible_places_;
};

}  // namespace tofmap

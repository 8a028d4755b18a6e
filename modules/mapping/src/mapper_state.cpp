// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Saves and restores what a RoomMapper knows besides the map.

#include "tofmap/mapping/mapper_state.hpp"

#include "state_json.hpp"
#include "tofmap/mapping/room_mapper.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>

namespace tofmap {

void check_covariance(const Eigen::Matrix<double, 6, 6>& covariance) {
  constexpr double rounding = 1e-6;
  constexpr double least = 1e-18;  // of a nanometre: what is less can hardly be inverted
  constexpr double most = 1e12;
  const bool is_symmetric =
      covariance.allFinite() && covariance.isApprox(covariance.transpose(), rounding);
  const bool is_plausible =
      covariance.diagonal().minCoeff() >= least && covariance.diagonal().maxCoeff() <= most;
  if (!is_symmetric || !is_plausible || covariance.llt().info() != Eigen::Success) {
    throw InputError("a covariance is invalid");
  }
}

/// Reads and writes the members of the classes that know where the camera is and what moves.
struct SavedState {
  static Json of(const MotionUncertainty& uncertainty) {
    return {{"joint", json_of<12, 12>(uncertainty.joint_)},
            {"mean_squares", json_of<6, 1>(uncertainty.mean_squares_)}};
  }

  static void restore(const Json& state, MotionUncertainty& uncertainty) {
    uncertainty.joint_ = matrix_in<MotionUncertainty::Joint>(state, "joint");
    uncertainty.mean_squares_ = matrix_in<MotionUncertainty::Twist>(state, "mean_squares");
  }

  static Json of(const std::optional<StampedPose>& pose) {
    return pose ? json_of(*pose) : Json(nullptr);
  }

  static std::optional<StampedPose> pose_in(const Json& state, const char* name) {
    const Json& value = member(state, name);
    return value.is_null() ? std::nullopt : std::optional(stamped_pose_in(value));
  }

  static Json of(const Odometry& odometry) {
    return {{"last", of(odometry.last_)},
            {"before_last", of(odometry.before_last_)},
            {"frames_since_registered", odometry.frames_since_registered_},
            {"recent_periods_s", odometry.recent_periods_s_},
            {"last_timestamp_s", odometry.last_timestamp_s_},
            {"uncertainty", of(odometry.uncertainty_)},
            {"reference", odometry.reference_},
            {"since_keyframe", of(odometry.since_keyframe_)},
            {"latest", odometry.latest_},
            {"usual_support", odometry.usual_support_},
            {"usual_inlier_ratio", odometry.usual_inlier_ratio_}};
  }

  static void restore(const Json& state, int keyframes, Odometry& odometry) {
    odometry.last_ = pose_in(state, "last");
    odometry.before_last_ = pose_in(state, "before_last");
    odometry.frames_since_registered_ = integer_in(state, "frames_since_registered", 0);
    odometry.recent_periods_s_.clear();
    for (const Json& period : list_in(state, "recent_periods_s")) {
      odometry.recent_periods_s_.push_back(number_in(period));
    }
    odometry.last_timestamp_s_ = number_in(state, "last_timestamp_s");
    restore(member(state, "uncertainty"), odometry.uncertainty_);
    odometry.reference_ = integer_in(state, "reference", -1, keyframes - 1);
    restore(member(state, "since_keyframe"), odometry.since_keyframe_);
    odometry.latest_ = integer_in(state, "latest", -1, keyframes - 1);
    odometry.usual_support_ = number_in(state, "usual_support");
    odometry.usual_inlier_ratio_ = number_in(state, "usual_inlier_ratio");
  }

  static Json of(const MovingRegions& regions) {
    Json points = Json::array();
    for (const MovingPoint& point : regions.known_) {
      points.push_back({{"world_m", json_of<3, 1>(point.world_m)}, {"age", point.age}});
    }
    return points;
  }

  static void restore(const Json& state, const char* name, MovingRegions& regions) {
    regions.known_.clear();
    for (const Json& point : list_in(state, name)) {
      regions.known_.push_back(
          {matrix_in<Eigen::Vector3d>(point, "world_m"), integer_in(point, "age", 0)});
    }
  }

  static Json of(const StillOdometry& odometry) {
    return {{"odometry", of(odometry.odometry_)},
            {"moving", of(odometry.moving_)},
            {"frames_since_front_moved", odometry.frames_since_front_moved_}};
  }

  static void restore(const Json& state, int keyframes, StillOdometry& odometry) {
    restore(member(state, "odometry"), keyframes, odometry.odometry_);
    restore(state, "moving", odometry.moving_);
    odometry.frames_since_front_moved_ = integer_in(state, "frames_since_front_moved", 0);
  }
};

MapperState RoomMapper::state() const {
  Json joins = Json::array();
  for (const JoinedMaps& join : joins_) {
    joins.push_back({{"map", join.map},
                     {"into", join.into},
                     {"found_in", join.found_in},
                     {"is_blind", join.is_blind}});
  }
  const auto list_of = [](std::span<const PoseEdge> edges) {
    Json list = Json::array();
    for (const PoseEdge& edge : edges) list.push_back(json_of(edge));
    return list;
  };
  Json held = Json::array();
  MapperState state;
  for (const NewFrame& frame : held_) {
    held.push_back({{"index", frame.index}, {"timestamp_s", frame.timestamp_s}});
    state.held.push_back(frame.cloud);
  }
  state.json = Json{
      {"odometry", SavedState::of(odometry_)},
      {"unfitted_loops", unfitted_loops_},
      {"waiting_loop", waiting_loop_},
      {"last_fit", last_fit_},
      {"last_slip_search", last_slip_search_},
      {"current", current_},
      {"map", map_},
      {"begun_maps", begun_maps_},
      {"lost_frames", lost_frames_},
      {"searched", searched_},
      {"joins", joins},
      {"compared_keyframes", evidence_.compared},
      {"differing_keyframes", evidence_.differing},
      {"joins_taken_back", joins_taken_back_},
      {"recognitions", list_of(recognitions_)},
      {"possible_places", list_of(possible_places_)},
      {"compared", nearness_.keyframes},
      {"recognised", nearness_.recognised},
      {"agreeing", nearness_.agreeing},
      {"obstacle", static_cast<int>(nearness_.obstacle)},
      {"start", start_ ? Json{{"map", start_->map},
                              {"pose", json_of(start_->world_from_camera)},
                              {"has_rotation", start_->has_rotation}}
                       : Json(nullptr)},
      {"held",
       held}}.dump();
  return state;
}

void RoomMapper::restore(MapContent content, const MapperState& state, int frames) {
  const Json json = Json::parse(state.json, nullptr, false);
  const int keyframes = content.keyframes.size();
  const int newest = std::max(keyframes - 1, 0);
  SavedState::restore(member(json, "odometry"), keyframes, odometry_);
  unfitted_loops_ = integer_in(json, "unfitted_loops", 0, static_cast<int>(content.loops.size()));
  waiting_loop_ = integer_in(json, "waiting_loop", -1, newest);
  last_fit_ = integer_in(json, "last_fit", 0, newest);
  last_slip_search_ = integer_in(json, "last_slip_search", -keyframes_between_fits, newest);
  current_ = integer_in(json, "current", 0, newest);
  begun_maps_ = integer_in(json, "begun_maps", 1, most_maps);
  map_ = integer_in(json, "map", 0, begun_maps_ - 1);
  lost_frames_ = integer_in(json, "lost_frames", 0);
  searched_ = integer_in(json, "searched", 0, keyframes);
  evidence_ = {.compared = integer_in(json, "compared_keyframes", 0),
               .differing = integer_in(json, "differing_keyframes", 0)};
  joins_taken_back_ = integer_in(json, "joins_taken_back", 0);
  joins_.clear();
  for (const Json& join : list_in(json, "joins")) {
    joins_.push_back({.map = integer_in(join, "map", 0, begun_maps_ - 1),
                      .into = integer_in(join, "into", 0, begun_maps_ - 1),
                      .found_in = integer_in(join, "found_in", 0, begun_maps_ - 1),
                      .is_blind = flag_in(join, "is_blind")});
  }
  const auto read_edges = [&](const char* name, std::vector<PoseEdge>& edges) {
    edges.clear();
    for (const Json& edge : list_in(json, name)) edges.push_back(edge_in(edge, keyframes));
  };
  read_edges("recognitions", recognitions_);
  read_edges("possible_places", possible_places_);
  nearness_ = {.keyframes = integer_in(json, "compared", 0),
               .recognised = integer_in(json, "recognised", 0),
               .agreeing = integer_in(json, "agreeing", 0),
               .obstacle = static_cast<JoinObstacle>(
                   integer_in(json, "obstacle", 0, static_cast<int>(JoinObstacle::ambiguous)))};
  start_.reset();
  if (const Json& start = member(json, "start"); !start.is_null()) {
    start_ = MapPlace{integer_in(start, "map", 0, begun_maps_ - 1), pose_in(start, "pose"),
                      flag_in(start, "has_rotation")};
  }
  const Json& held = list_in(json, "held");
  if (held.size() != state.held.size()) throw InputError("'held' does not fit its clouds");
  held_.clear();
  for (std::size_t i = 0; i < held.size(); ++i) {
    held_.push_back({.index = integer_in(held[i], "index", 0, frames - 1),
                     .timestamp_s = number_in(held[i], "timestamp_s"),
                     .cloud = state.held[i]});
  }
  for (const Keyframe& keyframe : content.keyframes.all()) {
    if (keyframe.map >= begun_maps_ || keyframe.taken_in >= begun_maps_) {
      throw InputError("a keyframe is in a map that has not begun");
    }
  }
  const int last = static_cast<int>(content.recordings.size()) - 1;
  for (const RegisteredFrame& frame : content.frames) {
    if (frame.recording == last && frame.index >= frames) {
      throw InputError("a frame was registered that was not read");
    }
  }
  content_ = std::move(content);
}

}  // namespace tofmap

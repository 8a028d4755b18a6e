// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Saves and loads the state of a RoomMapper.

#include "archive.hpp"
#include "tofmap/mapping/room_mapper.hpp"
#include "tofmap/mapping/tracking_state.hpp"

#include <istream>
#include <ostream>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array.hpp>
#include <boost/serialization/binary_object.hpp>
#include <boost/serialization/split_free.hpp>
#include <boost/serialization/unordered_map.hpp>

#include <tofmap/core/error.hpp>

namespace boost::serialization {

template <class Archive>
void save(Archive& archive, const tofmap::SurfaceCloud& cloud, unsigned) {
  archive << cloud.width << cloud.height;
  archive << make_binary_object(cloud.points.data(),
                                cloud.points.size() * sizeof(tofmap::SurfacePoint));
}

template <class Archive>
void load(Archive& archive, tofmap::SurfaceCloud& cloud, unsigned) {
  archive >> cloud.width >> cloud.height;
  cloud.points.resize(std::size_t{cloud.width} * cloud.height);
  cloud.is_dense = false;
  archive >>
      make_binary_object(cloud.points.data(), cloud.points.size() * sizeof(tofmap::SurfacePoint));
}

template <class Archive>
void serialize(Archive& archive, tofmap::SurfaceCloud& cloud, unsigned version) {
  split_free(archive, cloud, version);
}

template <class Archive>
void save(Archive& archive, const tofmap::Keyframe& keyframe, unsigned) {
  archive << keyframe.id << keyframe.frame_index << keyframe.timestamp_s;
  archive << keyframe.world_from_camera << keyframe.path_m << keyframe.map << keyframe.taken_in
          << *keyframe.cloud;
}

template <class Archive>
void load(Archive& archive, tofmap::Keyframe& keyframe, unsigned) {
  archive >> keyframe.id >> keyframe.frame_index >> keyframe.timestamp_s;
  auto cloud = std::make_shared<tofmap::SurfaceCloud>();
  archive >> keyframe.world_from_camera >> keyframe.path_m >> keyframe.map >> keyframe.taken_in >>
      *cloud;
  keyframe.place = tofmap::PlaceDescriptor(*cloud);
  keyframe.cloud = std::move(cloud);
}

template <class Archive>
void serialize(Archive& archive, tofmap::Keyframe& keyframe, unsigned version) {
  split_free(archive, keyframe, version);
}

template <class Archive>
void save(Archive& archive, const tofmap::NewFrame& frame, unsigned) {
  archive << frame.index << frame.timestamp_s << *frame.cloud;
}

template <class Archive>
void load(Archive& archive, tofmap::NewFrame& frame, unsigned) {
  auto cloud = std::make_shared<tofmap::SurfaceCloud>();
  archive >> frame.index >> frame.timestamp_s >> *cloud;
  frame.cloud = std::move(cloud);
}

template <class Archive>
void serialize(Archive& archive, tofmap::NewFrame& frame, unsigned version) {
  split_free(archive, frame, version);
}

template <class Archive>
void serialize(Archive& archive, tofmap::MovingPoint& point, unsigned) {
  archive& point.world_m& point.age;
}

template <class Archive>
void serialize(Archive& archive, tofmap::Loop& loop, unsigned) {
  archive& loop.from_frame& loop.to_frame& loop.error_m& loop.mahalanobis_distance& loop.is_used;
}

}  // namespace boost::serialization

namespace tofmap {

template <class Archive>
void KeyframeGraph::serialize(Archive& archive, unsigned) {
  archive& keyframes_& neighbours_;
}

template <class Archive>
void KeyframeGraph::Neighbour::serialize(Archive& archive, unsigned) {
  archive& id& spread& registered;
}

template <class Archive>
void MotionUncertainty::serialize(Archive& archive, unsigned) {
  archive& joint_& mean_squares_;
}

template <class Archive>
void Odometry::serialize(Archive& archive, unsigned) {
  archive& last_& before_last_& frames_since_registered_& recent_periods_s_& last_timestamp_s_;
  archive& uncertainty_& reference_& usual_support_& usual_inlier_ratio_;
}

template <class Archive>
void SurfaceMap::Voxel::serialize(Archive& archive, unsigned) {
  archive& weighted_point_m& weighted_normal& weight& confidence& observations;
}

template <class Archive>
void SurfaceMap::serialize(Archive& archive, unsigned) {
  archive& voxels_;
}

template <class Archive>
void RoomMapper::RegisteredFrame::serialize(Archive& archive, unsigned) {
  archive& timestamp_s& keyframe& keyframe_from_camera& index& sigma_m;
}

template <class Archive>
void RoomMapper::JoinedMaps::serialize(Archive& archive, unsigned) {
  archive& map& into& found_in& is_blind;
}

template <class Archive>
void MovingRegions::serialize(Archive& archive, unsigned) {
  archive& known_;
}

template <class Archive>
void StillOdometry::serialize(Archive& archive, unsigned) {
  archive& odometry_& moving_& frames_since_front_moved_;
}

template <class Archive>
void RoomMapper::serialize(Archive& archive, unsigned) {
  archive& odometry_& keyframes_& frames_& edges_& loops_;
  archive& unfitted_loops_& waiting_loop_& last_fit_& last_slip_search_& current_& map_&
      begun_maps_& lost_frames_& searched_;
  archive& held_& recognitions_& joins_& differing_keyframes_& joins_taken_back_;
}

void RoomMapper::save(std::ostream& out) const {
  boost::archive::binary_oarchive archive(out);
  archive << *this;
  const std::size_t submaps = submaps_.size();
  archive << submaps << submap_of_;
  for (const Submap& submap : submaps_) archive << submap.anchor << submap.surface;
}

void RoomMapper::load(std::istream& in) {
  boost::archive::binary_iarchive archive(in);
  archive >> *this;
  std::size_t submaps = 0;
  archive >> submaps >> submap_of_;
  submaps_.assign(submaps, {0, SurfaceMap(surface_options_)});
  for (Submap& submap : submaps_) archive >> submap.anchor >> submap.surface;
}

void save_tracking(const std::vector<TrackingResult>& results, std::ostream& out) {
  boost::archive::binary_oarchive archive(out);
  archive << results;
}

std::vector<TrackingResult> load_tracking(std::istream& in) {
  boost::archive::binary_iarchive archive(in);
  std::vector<TrackingResult> results;
  archive >> results;
  return results;
}

}  // namespace tofmap

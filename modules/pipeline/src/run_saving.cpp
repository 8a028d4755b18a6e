// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Saving and loading the state of a MapRun.

#include "run_rows.hpp"
#include "tofmap/pipeline/pipeline.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include <tofmap/core/bytes.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/mapping/map_store.hpp>

namespace tofmap {
namespace {

constexpr const char* mapper_entry = "run/mapper";
constexpr const char* measurer_entry = "run/measurer";
constexpr const char* errors_entry = "run/errors";
constexpr const char* held_entries = "run/held/";

/// The fields of a point in the order in which they are stored.
constexpr std::array<float SurfacePoint::*, 3> single_fields{
    &SurfacePoint::sigma_m, &SurfacePoint::normal_sigma_rad, &SurfacePoint::confidence};
constexpr Eigen::Index floats_per_point = 6 + static_cast<Eigen::Index>(single_fields.size());

/// A cloud exact to the bit.
std::string bytes_of(const SurfaceCloud& cloud) {
  ImageF floats(static_cast<Eigen::Index>(cloud.size()), floats_per_point);
  for (Eigen::Index i = 0; i < floats.rows(); ++i) {
    const SurfacePoint& point = cloud.points[static_cast<std::size_t>(i)];
    floats.row(i).head<3>() = point.getVector3fMap().transpose();
    floats.row(i).segment<3>(3) = point.getNormalVector3fMap().transpose();
    for (std::size_t field = 0; field < single_fields.size(); ++field) {
      floats(i, 6 + static_cast<Eigen::Index>(field)) = point.*single_fields[field];
    }
  }
  ByteWriter out;
  out.image(floats);
  return out.take();
}

SurfaceCloud cloud_in(const std::string& bytes, const CameraModel& camera) {
  const Eigen::Index pixels = Eigen::Index{camera.width_px} * camera.height_px;
  ByteReader in(bytes);
  const ImageF floats = in.image<float>(pixels, floats_per_point);
  in.expect_end();
  if (floats.rows() != pixels) throw InputError("a cloud is empty");
  SurfaceCloud cloud;
  cloud.width = static_cast<std::uint32_t>(camera.width_px);
  cloud.height = static_cast<std::uint32_t>(camera.height_px);
  cloud.is_dense = false;
  cloud.points.resize(static_cast<std::size_t>(pixels));
  for (Eigen::Index i = 0; i < pixels; ++i) {
    SurfacePoint& point = cloud.points[static_cast<std::size_t>(i)];
    point.getVector3fMap() = floats.row(i).head<3>().matrix().transpose();
    point.getNormalVector3fMap() = floats.row(i).segment<3>(3).matrix().transpose();
    point.data[3] = 1;
    point.data_n[3] = 0;
    for (std::size_t field = 0; field < single_fields.size(); ++field) {
      point.*single_fields[field] = floats(i, 6 + static_cast<Eigen::Index>(field));
    }
  }
  return cloud;
}

/// An entry that must be there, read from its bytes to their end.
template <class Read>
void read_entry(const MapStore& store, const char* name, const Read& read) {
  const std::string bytes = store.expected_entry(name);
  naming(name, [&] {
    ByteReader in(bytes);
    read(in);
    in.expect_end();
  });
}

MapperState mapper_state_in(const MapStore& store, const CameraModel& camera) {
  MapperState state;
  state.json = store.expected_entry(mapper_entry);
  for (const std::string& name : store.entries(held_entries)) {
    state.held.push_back(
        std::make_shared<const SurfaceCloud>(cloud_in(store.expected_entry(name), camera)));
  }
  return state;
}

/// The last frame that could be read and repeats none. Empty if there is none.
Frame last_read(const std::vector<FrameRecord>& frames,
                const std::function<SourcedFrame(int index)>& read_frame) {
  for (auto record = frames.rbegin(); record != frames.rend(); ++record) {
    if (!record->is_prepared()) continue;
    SourcedFrame sourced = read_frame(record->index);
    if (!sourced.frame) throw InputError("a frame of the recording was readable before");
    return *std::move(sourced.frame);
  }
  return {};
}

}  // namespace

void MapRun::save_map(MapStore::Commit& commit) const {
  commit.write(mapper_.content());
  const int recording = static_cast<int>(mapper_.content().recordings.size()) - 1;
  std::vector<FrameRow> rows;
  for (std::size_t i = first_unsaved_; i < frames_.size(); ++i) {
    rows.push_back(frame_row(frames_[i], recording));
  }
  commit.put(rows);
}

void MapRun::save(MapStore::Commit& commit) const {
  save_map(commit);
  ByteWriter bytes;
  measurer_.save(bytes);
  commit.put(measurer_entry, bytes.take());
  errors_.save(bytes);
  commit.put(errors_entry, bytes.take());
  const MapperState state = mapper_.state();
  commit.put(mapper_entry, state.json);
  commit.remove(held_entries);
  for (std::size_t i = 0; i < state.held.size(); ++i) {
    commit.put(fmt::format("{}{:06}", held_entries, i), bytes_of(*state.held[i]));
  }
}

void MapRun::load(const MapStore& store, const std::function<SourcedFrame(int index)>& read_frame) {
  MapContent content = store.content();
  const int recording = static_cast<int>(content.recordings.size()) - 1;
  frames_.clear();
  for (const FrameRow& row : store.frame_rows(recording)) frames_.push_back(frame_record(row));
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (frames_[i].index != static_cast<int>(i)) throw InputError("rows of frames are missing");
  }
  first_unsaved_ = frames_.size();
  mapper_.restore(std::move(content), mapper_state_in(store, sensor_.camera),
                  static_cast<int>(frames_.size()));
  read_entry(store, measurer_entry, [&](ByteReader& in) { measurer_.load(in); });
  read_entry(store, errors_entry, [&](ByteReader& in) { errors_.load(in); });
  last_ = last_read(frames_, read_frame);
  ahead_.clear();
}

}  // namespace tofmap

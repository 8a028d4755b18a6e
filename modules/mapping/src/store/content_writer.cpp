// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "content_writer.hpp"

#include "change_rows.hpp"
#include "crc_sum.hpp"
#include "insertion.hpp"
#include "registration_rows.hpp"
#include "rows.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include <tofmap/core/bytes.hpp>

namespace tofmap {
namespace {

/// Whether two poses are the same to the bit.
bool is_same(const Pose& one, const Pose& other) { return one.matrix() == other.matrix(); }

bool is_same(const WrittenKeyframe& one, const WrittenKeyframe& other) {
  return is_same(one.world_from_camera, other.world_from_camera) &&
         one.recording == other.recording && one.frame_index == other.frame_index &&
         one.map == other.map && one.taken_in == other.taken_in && one.submap == other.submap &&
         one.cloud == other.cloud;  // the descriptor of the place follows from it
}

WrittenKeyframe row_of(const Keyframe& keyframe, const MapContent& content) {
  return {.world_from_camera = keyframe.world_from_camera,
          .recording = keyframe.recording,
          .frame_index = keyframe.frame_index,
          .map = keyframe.map,
          .taken_in = keyframe.taken_in,
          .submap = content.submap_of[static_cast<std::size_t>(keyframe.id)],
          .cloud = keyframe.cloud.number()};
}

/// Of all that the row of a frame holds but its time. Two different ones have the same checksum
/// once in four thousand million times; then the row keeps the earlier pose.
std::uint32_t checksum_of(const RegisteredFrame& frame) {
  ByteWriter bytes;
  bytes.number(frame.index);
  bytes.number(frame.recording);
  bytes.number(frame.keyframe);
  for (const double number : frame.keyframe_from_camera.matrix().reshaped()) bytes.number(number);
  for (const double number : frame.covariance.reshaped()) bytes.number(number);
  CrcSum sum;
  sum.add(bytes.take());
  return sum.value();
}

/// Removes the rows whose number in a column is at least `first`, if there are any.
void remove_from(SQLite::Database& database, const std::string& table, const std::string& column,
                 std::size_t first) {
  database.exec("DELETE FROM " + table + " WHERE " + column + " >= " + std::to_string(first));
}

void write_properties(const MapContent& content, SQLite::Database& database) {
  Insertion row(database, "properties", 2);
  row.statement.bind(1, "surface");
  row.statement.bind(2, surface_options_json(content.surface_options));
  row.execute();
}

void write_recordings(const MapContent& content, SQLite::Database& database) {
  Insertion row(database, "recordings", 7);
  for (std::size_t i = 0; i < content.recordings.size(); ++i) {
    const MapRecording& recording = content.recordings[i];
    int column = 1;
    row.statement.bind(column++, static_cast<int>(i));
    row.statement.bind(column++, recording.source);
    row.statement.bind(column++, recording.added);
    row.statement.bind(column++, recording.version);
    row.statement.bind(column++, sensor_json(recording.sensor));
    row.statement.bind(column++, recording.options);
    row.statement.bind(column++, recording.verdict);
    row.execute();
  }
}

void write_submaps(const MapContent& content, const WrittenContent& before,
                   SQLite::Database& database) {
  const std::size_t known = before.submap_revisions.size();
  Insertion row(database, "submaps", 4);
  for (std::size_t i = 0; i < content.submaps.size(); ++i) {
    const Submap& submap = content.submaps[i];
    if (i < known && before.submap_revisions[i] == submap.surface.revision() &&
        before.submap_anchors[i] == submap.anchor) {
      continue;
    }
    const std::string bytes = submap.surface.load()->to_bytes();
    row.statement.bind(1, static_cast<int>(i));
    row.statement.bind(2, submap.anchor);
    row.statement.bind(3, static_cast<std::int64_t>(submap.surface.size()));
    bind_bytes(row.statement, 4, bytes);
    row.execute();
  }
  remove_from(database, "submaps", "id", content.submaps.size());
}

/// Indices of all submaps but the latest. Those that are aside already may have been in other rows.
std::vector<int> submaps_to_put_aside(const MapContent& content) {
  const auto latest = latest_submap(content);
  std::vector<int> indices;
  for (std::size_t i = 0; i < content.submaps.size(); ++i) {
    if (i != latest || content.submaps[i].surface.is_aside()) {
      indices.push_back(static_cast<int>(i));
    }
  }
  return indices;
}

void write_cloud(const Keyframe& keyframe, Insertion& row) {
  const CompactCloud compact = keyframe.cloud.compact();
  row.statement.bind(1, keyframe.id);
  row.statement.bind(2, compact.width_px);
  row.statement.bind(3, compact.height_px);
  row.statement.bindNoCopy(4, compact.bytes.data(), static_cast<int>(compact.bytes.size()));
  row.execute();
}

/// Returns the ids of the keyframes whose clouds were written.
std::vector<int> write_keyframes(const MapContent& content, const WrittenContent& before,
                                 const WrittenContent& after, SQLite::Database& database) {
  const std::size_t known = before.keyframes.size();
  std::vector<int> written_clouds;
  Insertion row(database, "keyframes", 9 + pose_columns);
  Insertion cloud_row(database, "clouds", 4);
  for (const Keyframe& keyframe : content.keyframes.all()) {
    const auto id = static_cast<std::size_t>(keyframe.id);
    const WrittenKeyframe& now = after.keyframes[id];
    if (id >= known || now.cloud != before.keyframes[id].cloud) {
      write_cloud(keyframe, cloud_row);
      written_clouds.push_back(keyframe.id);
    }
    if (id < known && is_same(now, before.keyframes[id])) continue;
    int column = 1;
    row.statement.bind(column++, keyframe.id);
    row.statement.bind(column++, keyframe.recording);
    row.statement.bind(column++, keyframe.frame_index);
    row.statement.bind(column++, keyframe.timestamp_s);
    row.statement.bind(column++, keyframe.map);
    row.statement.bind(column++, keyframe.taken_in);
    row.statement.bind(column++, keyframe.path_m);
    row.statement.bind(column++, now.submap);
    bind_pose(row.statement, column, keyframe.world_from_camera);
    column += pose_columns;
    const std::string place = keyframe.place.to_bytes();
    bind_bytes(row.statement, column, place);
    row.execute();
  }
  const auto size = static_cast<std::size_t>(content.keyframes.size());
  remove_from(database, "clouds", "keyframe", size);
  remove_from(database, "keyframes", "id", size);
  return written_clouds;
}

void write_links(const MapContent& content, const WrittenContent& before,
                 SQLite::Database& database) {
  const std::size_t known = before.links.size();
  Insertion row(database, "links", 7);
  for (int id = 0; id < content.keyframes.size(); ++id) {
    const auto links = content.keyframes.links(id);
    const auto at = static_cast<std::size_t>(id);
    if (at < known && std::ranges::equal(links, before.links[at])) continue;
    database.exec("DELETE FROM links WHERE keyframe = " + std::to_string(id));
    for (std::size_t place = 0; place < links.size(); ++place) {
      const KeyframeLink& link = links[place];
      row.statement.bind(1, id);
      row.statement.bind(2, static_cast<int>(place));
      row.statement.bind(3, link.to);
      row.statement.bind(4, link.spread.rotation_rad2);
      row.statement.bind(5, link.spread.translation_m2);
      if (link.registered) {
        row.statement.bind(6, link.registered->rotation_rad2);
        row.statement.bind(7, link.registered->translation_m2);
      }
      row.execute();
    }
  }
  remove_from(database, "links", "keyframe", static_cast<std::size_t>(content.keyframes.size()));
}

void write_constraints(const MapContent& content, SQLite::Database& database) {
  std::vector<Pose> poses;
  for (const Keyframe& keyframe : content.keyframes.all()) {
    poses.push_back(keyframe.world_from_camera);
  }
  database.exec("DELETE FROM constraints");
  Insertion row(database, "constraints", 8 + pose_columns + 1);
  auto loop = content.loops.begin();
  for (std::size_t i = 0; i < content.edges.size(); ++i) {
    const PoseEdge& edge = content.edges[i];
    int column = 1;
    row.statement.bind(column++, static_cast<int>(i));
    row.statement.bind(column++, edge.may_be_wrong ? "loop" : "odometry");
    row.statement.bind(column++, edge.from);
    row.statement.bind(column++, edge.to);
    row.statement.bind(column++, mahalanobis_distance(edge, poses));
    row.statement.bind(column++, edge.may_be_wrong && !loop->is_used ? 0 : 1);
    if (edge.may_be_wrong) {
      row.statement.bind(column, loop->error_m);
      row.statement.bind(column + 1, loop->mahalanobis_distance);
      ++loop;
    }
    column += 2;
    bind_pose(row.statement, column, edge.from_from_to);
    column += pose_columns;
    bind_numbers(row.statement, column, edge.covariance.data(),
                 static_cast<int>(edge.covariance.size()));
    row.execute();
  }
}

void write_frames(const MapContent& content, const WrittenContent& before,
                  const WrittenContent& after, SQLite::Database& database) {
  remove_from(database, "registrations", "frame", content.frames.size());
  remove_from(database, "frames", "id", content.frames.size());
  Insertion row(database, "frames", 6 + pose_columns);
  for (std::size_t i = 0; i < content.frames.size(); ++i) {
    const RegisteredFrame& frame = content.frames[i];
    if (i < before.frames.size() && after.frames[i] == before.frames[i]) continue;
    int column = 1;
    row.statement.bind(column++, static_cast<std::int64_t>(i));
    row.statement.bind(column++, frame.recording);
    row.statement.bind(column++, frame.index);
    row.statement.bind(column++, frame.timestamp_s);
    row.statement.bind(column++, frame.keyframe);
    bind_pose(row.statement, column, frame.keyframe_from_camera);
    column += pose_columns;
    bind_numbers(row.statement, column, frame.covariance.data(),
                 static_cast<int>(frame.covariance.size()));
    row.execute();
  }
}

}  // namespace

WrittenContent written(const MapContent& content) {
  WrittenContent written;
  for (const Keyframe& keyframe : content.keyframes.all()) {
    written.keyframes.push_back(row_of(keyframe, content));
    const auto links = content.keyframes.links(keyframe.id);
    written.links.emplace_back(links.begin(), links.end());
  }
  for (const Submap& submap : content.submaps) {
    written.submap_anchors.push_back(submap.anchor);
    written.submap_revisions.push_back(submap.surface.revision());
  }
  for (const RegisteredFrame& frame : content.frames) written.frames.push_back(checksum_of(frame));
  written.constraints = constraint_checksums(content.frames);
  written.changes = checksum_of(content.changes);
  return written;
}

StoredParts write_content(const MapContent& content, const WrittenContent& before,
                          const WrittenContent& after, SQLite::Database& database) {
  write_properties(content, database);
  write_recordings(content, database);
  StoredParts stored;
  write_submaps(content, before, database);
  stored.submaps = submaps_to_put_aside(content);
  stored.clouds = write_keyframes(content, before, after, database);
  write_links(content, before, database);
  write_constraints(content, database);
  write_frames(content, before, after, database);
  write_registrations(content.frames, before.constraints, after.constraints, database);
  if (after.changes != before.changes) write_changes(content.changes, database);
  return stored;
}

}  // namespace tofmap

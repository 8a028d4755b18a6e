// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "content_reader.hpp"

#include "../state_json.hpp"
#include "change_rows.hpp"
#include "registration_rows.hpp"
#include "rows.hpp"

#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace tofmap {
namespace {

constexpr int any = std::numeric_limits<int>::max();

/// Reads the rows of a table in order. If a row is damaged, the message names the table and its
/// number.
template <class Read>
void for_each_row(SQLite::Database& database, const std::string& table, const std::string& order,
                  const Read& read) {
  SQLite::Statement row(database, "SELECT * FROM " + table + " ORDER BY " + order);
  for (int number = 0; row.executeStep(); ++number) {
    naming(fmt::format("table '{}', row {}", table, number), [&] { read(row, number); });
  }
}

/// Throws InputError unless the first column is the number of the row.
void expect_id(SQLite::Statement& row, int number) {
  if (row.getColumn(0).getInt64() != number) throw InputError("rows are missing");
}

SurfaceMapOptions read_surface_options(SQLite::Database& database) {
  SQLite::Statement row(database, "SELECT value FROM properties WHERE name = 'surface'");
  if (!row.executeStep()) throw InputError("table 'properties' lacks 'surface'");
  return naming("table 'properties', 'surface'",
                [&] { return surface_options_in(row.getColumn(0).getString()); });
}

std::vector<MapRecording> read_recordings(SQLite::Database& database) {
  std::vector<MapRecording> recordings;
  for_each_row(database, "recordings", "id", [&](SQLite::Statement& row, int number) {
    expect_id(row, number);
    MapRecording recording;
    recording.source = row.getColumn(1).getString();
    recording.added = row.getColumn(2).getString();
    recording.version = row.getColumn(3).getString();
    recording.sensor = sensor_in(row.getColumn(4).getString());
    recording.options = row.getColumn(5).getString();
    recording.verdict = row.getColumn(6).getString();
    recordings.push_back(std::move(recording));
  });
  if (recordings.empty()) throw InputError("is a map of no recording");
  for (const MapRecording& recording : recordings) {
    if (!are_same_camera(recording.sensor.camera, recordings.front().sensor.camera)) {
      throw InputError("its recordings are of different cameras");
    }
  }
  return recordings;
}

int count_rows(SQLite::Database& database, const std::string& table) {
  return database.execAndGet("SELECT COUNT(*) FROM " + table).getInt();
}

void read_submaps(SQLite::Database& database, int keyframes, const PartReaders& readers,
                  MapContent& content) {
  for_each_row(database, "submaps", "id", [&](SQLite::Statement& row, int number) {
    expect_id(row, number);
    const SQLite::Column surface = row.getColumn(3);
    content.submaps.push_back({integer_in(row, 1, 0, keyframes - 1),
                               surface_from_bytes(bytes_in(surface), content.surface_options)});
    content.submaps.back().surface.put_aside(
        [read = readers.surface, number, options = content.surface_options] {
          return read(number, options);
        });
  });
}

void read_keyframes(SQLite::Database& database,
                    const std::function<CompactCloud(int keyframe)>& read_cloud,
                    MapContent& content) {
  const int recordings = static_cast<int>(content.recordings.size());
  const int submaps = static_cast<int>(content.submaps.size());
  for_each_row(database, "keyframes", "id", [&](SQLite::Statement& row, int number) {
    expect_id(row, number);
    Keyframe keyframe{.id = number};
    keyframe.recording = integer_in(row, 1, 0, recordings - 1);
    keyframe.frame_index = integer_in(row, 2, 0, any);
    keyframe.timestamp_s = number_in(row, 3);
    keyframe.map = integer_in(row, 4, 0, most_maps - 1);
    keyframe.taken_in = integer_in(row, 5, 0, most_maps - 1);
    keyframe.path_m = number_in(row, 6);
    content.submap_of.push_back(integer_in(row, 7, 0, submaps - 1));
    constexpr int first = 8;
    keyframe.world_from_camera = pose_in(row, first);
    const SQLite::Column place = row.getColumn(first + pose_columns);
    keyframe.place = place_from_bytes(bytes_in(place));
    content.keyframes.add(std::move(keyframe), [read_cloud, number] { return read_cloud(number); });
  });
  if (count_rows(database, "clouds") != content.keyframes.size()) {
    throw InputError("does not have a cloud for each keyframe");
  }
}

PoseSpread spread_in(SQLite::Statement& row, int first) {
  const PoseSpread spread{number_in(row, first), number_in(row, first + 1)};
  if (spread.rotation_rad2 < 0 || spread.translation_m2 < 0) {
    throw InputError("a variance is negative");
  }
  return spread;
}

void read_links(SQLite::Database& database, MapContent& content) {
  const int keyframes = content.keyframes.size();
  std::vector<std::vector<KeyframeLink>> links(static_cast<std::size_t>(keyframes));
  for_each_row(database, "links", "keyframe, place", [&](SQLite::Statement& row, int /*number*/) {
    const int from = integer_in(row, 0, 0, keyframes - 1);
    KeyframeLink link{.to = integer_in(row, 2, 0, keyframes - 1),
                      .spread = spread_in(row, 3),
                      .registered = std::nullopt};
    constexpr int registered = 5;
    if (!row.isColumnNull(registered)) link.registered = spread_in(row, registered);
    if (link.to == from) throw InputError("a keyframe is linked with itself");
    links[static_cast<std::size_t>(from)].push_back(link);
  });
  for (int id = 0; id < keyframes; ++id) {
    content.keyframes.set_links(id, std::move(links[static_cast<std::size_t>(id)]));
  }
}

Eigen::Matrix<double, 6, 6> numbers_in(SQLite::Statement& row, int index) {
  Eigen::Matrix<double, 6, 6> matrix;
  read_numbers(row, index, matrix.data(), static_cast<int>(matrix.size()));
  return matrix;
}

void read_constraints(SQLite::Database& database, MapContent& content) {
  const int keyframes = content.keyframes.size();
  for_each_row(database, "constraints", "id", [&](SQLite::Statement& row, int number) {
    expect_id(row, number);
    PoseEdge edge;
    edge.may_be_wrong = row.getColumn(1).getString() == "loop";
    edge.from = integer_in(row, 2, 0, keyframes - 1);
    edge.to = integer_in(row, 3, 0, keyframes - 1);
    if (edge.from == edge.to) throw InputError("a constraint connects a keyframe with itself");
    constexpr int first = 8;
    edge.from_from_to = pose_in(row, first);
    edge.covariance = numbers_in(row, first + pose_columns);
    check_covariance(edge.covariance);
    content.edges.push_back(edge);
    if (!edge.may_be_wrong) return;
    Loop loop;
    loop.from_frame = content.keyframes[edge.from].frame_index;
    loop.to_frame = content.keyframes[edge.to].frame_index;
    loop.is_used = integer_in(row, 5, 0, 1) != 0;
    loop.error_m = number_in(row, 6);
    loop.mahalanobis_distance = number_in(row, 7);
    content.loops.push_back(loop);
  });
}

void read_frames(SQLite::Database& database, MapContent& content) {
  const int recordings = static_cast<int>(content.recordings.size());
  for_each_row(database, "frames", "id", [&](SQLite::Statement& row, int number) {
    expect_id(row, number);
    RegisteredFrame frame;
    frame.recording = integer_in(row, 1, 0, recordings - 1);
    frame.index = integer_in(row, 2, 0, any);
    frame.timestamp_s = number_in(row, 3);
    frame.keyframe = integer_in(row, 4, 0, content.keyframes.size() - 1);
    constexpr int first = 5;
    frame.keyframe_from_camera = pose_in(row, first);
    frame.covariance = numbers_in(row, first + pose_columns);
    if (!frame.covariance.isZero(0)) check_covariance(frame.covariance);
    content.frames.push_back(std::move(frame));
  });
}

}  // namespace

MapContent read_content(SQLite::Database& database, const PartReaders& readers) {
  std::vector<MapRecording> recordings = read_recordings(database);
  MapContent content(recordings.front().sensor.camera, read_surface_options(database));
  content.recordings = std::move(recordings);
  read_submaps(database, count_rows(database, "keyframes"), readers, content);
  read_keyframes(database, readers.cloud, content);
  read_links(database, content);
  read_constraints(database, content);
  read_frames(database, content);
  if (format_version(database) > 1) {
    for_each_row(database, "registrations", "frame, place",
                 [&](SQLite::Statement& row, int /*number*/) {
                   read_registration(row, content.keyframes.size(), content.frames);
                 });
  }
  const int count = static_cast<int>(content.recordings.size());
  for_each_row(database, "changes", "id", [&](SQLite::Statement& row, int number) {
    expect_id(row, number);
    content.changes.push_back(change_in(row, count));
  });
  return content;
}

}  // namespace tofmap

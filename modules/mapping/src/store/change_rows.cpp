// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "change_rows.hpp"

#include "../state_json.hpp"
#include "crc_sum.hpp"
#include "insertion.hpp"
#include "rows.hpp"

#include <limits>
#include <string>

#include <tofmap/core/bytes.hpp>

namespace tofmap {
namespace {

/// The columns of the table `changes`.
struct Column {
  enum { id, map, recording, kind, points, box, moved = 11, motion, before, after, count };
};

constexpr int numbers_per_point = 7;
constexpr std::size_t bytes_per_point =
    numbers_per_point * sizeof(float) + 2 * sizeof(std::uint32_t);

std::string bytes_of(const MapCloud& cloud) {
  ByteWriter out;
  for (const MapPoint& point : cloud) {
    for (const float coordinate : point.getVector3fMap()) out.number(coordinate);
    for (const float coordinate : point.getNormalVector3fMap()) out.number(coordinate);
    out.number(point.confidence);
    out.number(point.observations);
    out.number(point.recording);
  }
  return out.take();
}

MapCloud cloud_in(std::string_view bytes, int recordings) {
  if (bytes.size() % bytes_per_point != 0) throw InputError("stored bytes end early");
  MapCloud cloud;
  cloud.resize(bytes.size() / bytes_per_point);
  ByteReader in(bytes);
  for (MapPoint& point : cloud) {
    for (float& coordinate : point.getVector3fMap()) coordinate = in.number<float>();
    point.data[3] = 1;
    for (float& coordinate : point.getNormalVector3fMap()) coordinate = in.number<float>();
    point.data_n[3] = 0;
    point.confidence = in.number<float>(0, 1);
    point.observations = in.number<std::uint32_t>();
    point.recording = in.number<std::uint32_t>(0, static_cast<std::uint32_t>(recordings - 1));
  }
  return cloud;
}

}  // namespace

std::uint32_t checksum_of(std::span<const MapChange> changes) {
  CrcSum sum;
  for (const MapChange& change : changes) {
    ByteWriter out;
    out.number(static_cast<int>(change.kind));
    out.number(change.map);
    out.number(change.recording);
    out.numbers({change.after_from_before.data(), 16});
    sum.add(out.take());
    sum.add(bytes_of(change.before));
    sum.add(bytes_of(change.after));
  }
  return sum.value();
}

void write_changes(std::span<const MapChange> changes, SQLite::Database& database) {
  database.exec("DELETE FROM changes");
  Insertion insertion(database, "changes", Column::count);
  SQLite::Statement& row = insertion.statement;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const MapChange& change = changes[i];
    // Parameters count from 1, columns from 0.
    row.bind(1 + Column::id, static_cast<int>(i));
    row.bind(1 + Column::map, change.map);
    row.bind(1 + Column::recording, change.recording);
    row.bind(1 + Column::kind, std::string(name_of(change.kind)));
    row.bind(1 + Column::points, static_cast<int>(point_count(change)));
    const Eigen::AlignedBox3f box = box_of(change.before).merged(box_of(change.after));
    for (int axis = 0; axis < 3; ++axis) {
      row.bind(1 + Column::box + 2 * axis, static_cast<double>(box.min()[axis]));
      row.bind(2 + Column::box + 2 * axis, static_cast<double>(box.max()[axis]));
    }
    if (change.kind == ChangeKind::moved) row.bind(1 + Column::moved, moved_m(change));
    bind_numbers(row, 1 + Column::motion, change.after_from_before.data(), 16);
    const std::string before_bytes = bytes_of(change.before);
    const std::string after_bytes = bytes_of(change.after);
    bind_bytes(row, 1 + Column::before, before_bytes);
    bind_bytes(row, 1 + Column::after, after_bytes);
    insertion.execute();
  }
}

MapChange change_in(SQLite::Statement& row, int recordings) {
  MapChange change;
  change.map = integer_in(row, Column::map, 0, std::numeric_limits<int>::max());
  change.recording = integer_in(row, Column::recording, 1, recordings - 1);
  const auto named = find_named<ChangeKind>(row.getColumn(Column::kind).getString());
  if (!named) throw InputError("a change is neither 'gone', 'new' nor 'moved'");
  change.kind = *named;
  Eigen::Matrix4d matrix;
  read_numbers(row, Column::motion, matrix.data(), static_cast<int>(matrix.size()));
  check_rotation(matrix.topLeftCorner<3, 3>());
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) throw InputError("a motion is invalid");
  change.after_from_before = Pose(matrix);
  const SQLite::Column before_bytes = row.getColumn(Column::before);
  const SQLite::Column after_bytes = row.getColumn(Column::after);
  change.before = cloud_in(bytes_in(before_bytes), recordings);
  change.after = cloud_in(bytes_in(after_bytes), recordings);
  if (change.before.empty() != (change.kind == ChangeKind::appeared) ||
      change.after.empty() != (change.kind == ChangeKind::gone)) {
    throw InputError("a change has points that do not fit its kind");
  }
  return change;
}

}  // namespace tofmap

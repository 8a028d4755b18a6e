// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "schema.hpp"

namespace tofmap {
namespace {

/// Since version 2.
constexpr const char* registrations_schema = R"sql(
CREATE TABLE registrations (
  frame INTEGER NOT NULL REFERENCES frames(id),
  place INTEGER NOT NULL,
  keyframe INTEGER NOT NULL REFERENCES keyframes(id),
  x_m REAL NOT NULL,
  y_m REAL NOT NULL,
  z_m REAL NOT NULL,
  rotation BLOB NOT NULL,
  information BLOB NOT NULL,
  gradient BLOB NOT NULL,
  PRIMARY KEY (frame, place)
) WITHOUT ROWID;
)sql";

std::string version_statement() {
  return "PRAGMA user_version = " + std::to_string(map_format_version) + ";";
}

}  // namespace

std::string map_schema_since(int version) {
  return version < 2 ? registrations_schema + version_statement() : std::string();
}

std::string map_schema() {
  return "BEGIN; PRAGMA application_id = " + std::to_string(map_application_id) + ";" +
         version_statement() + registrations_schema + R"sql(

CREATE TABLE properties (
  name TEXT PRIMARY KEY,
  value TEXT NOT NULL
) WITHOUT ROWID;

CREATE TABLE recordings (
  id INTEGER PRIMARY KEY,
  source TEXT NOT NULL,
  added TEXT NOT NULL,
  version TEXT NOT NULL,
  sensor TEXT NOT NULL,
  options TEXT NOT NULL,
  verdict TEXT NOT NULL
);

CREATE TABLE submaps (
  id INTEGER PRIMARY KEY,
  anchor INTEGER NOT NULL REFERENCES keyframes(id),
  voxels INTEGER NOT NULL,
  surface BLOB NOT NULL
);

CREATE TABLE keyframes (
  id INTEGER PRIMARY KEY,
  recording INTEGER NOT NULL REFERENCES recordings(id),
  frame INTEGER NOT NULL,
  timestamp_s REAL NOT NULL,
  map INTEGER NOT NULL,
  taken_in INTEGER NOT NULL,
  path_m REAL NOT NULL,
  submap INTEGER NOT NULL REFERENCES submaps(id),
  x_m REAL NOT NULL,
  y_m REAL NOT NULL,
  z_m REAL NOT NULL,
  qx REAL NOT NULL,
  qy REAL NOT NULL,
  qz REAL NOT NULL,
  qw REAL NOT NULL,
  rotation BLOB NOT NULL,
  place BLOB NOT NULL
);

CREATE TABLE clouds (
  keyframe INTEGER PRIMARY KEY REFERENCES keyframes(id),
  width_px INTEGER NOT NULL,
  height_px INTEGER NOT NULL,
  points BLOB NOT NULL
);

CREATE TABLE constraints (
  id INTEGER PRIMARY KEY,
  kind TEXT NOT NULL CHECK (kind IN ('odometry', 'loop')),
  from_keyframe INTEGER NOT NULL REFERENCES keyframes(id),
  to_keyframe INTEGER NOT NULL REFERENCES keyframes(id),
  residual REAL NOT NULL,
  is_used INTEGER NOT NULL,
  error_m REAL,
  residual_at_fit REAL,
  x_m REAL NOT NULL,
  y_m REAL NOT NULL,
  z_m REAL NOT NULL,
  qx REAL NOT NULL,
  qy REAL NOT NULL,
  qz REAL NOT NULL,
  qw REAL NOT NULL,
  rotation BLOB NOT NULL,
  covariance BLOB NOT NULL
);

CREATE TABLE links (
  keyframe INTEGER NOT NULL REFERENCES keyframes(id),
  place INTEGER NOT NULL,
  neighbour INTEGER NOT NULL REFERENCES keyframes(id),
  rotation_rad2 REAL NOT NULL,
  translation_m2 REAL NOT NULL,
  registered_rotation_rad2 REAL,
  registered_translation_m2 REAL,
  PRIMARY KEY (keyframe, place)
) WITHOUT ROWID;

CREATE TABLE frames (
  id INTEGER PRIMARY KEY,
  recording INTEGER NOT NULL REFERENCES recordings(id),
  frame INTEGER NOT NULL,
  timestamp_s REAL NOT NULL,
  keyframe INTEGER NOT NULL REFERENCES keyframes(id),
  x_m REAL NOT NULL,
  y_m REAL NOT NULL,
  z_m REAL NOT NULL,
  qx REAL NOT NULL,
  qy REAL NOT NULL,
  qz REAL NOT NULL,
  qw REAL NOT NULL,
  rotation BLOB NOT NULL,
  covariance BLOB NOT NULL
);

CREATE TABLE changes (
  id INTEGER PRIMARY KEY,
  map INTEGER NOT NULL,
  recording INTEGER NOT NULL REFERENCES recordings(id),
  kind TEXT NOT NULL CHECK (kind IN ('gone', 'new', 'moved')),
  points INTEGER NOT NULL,
  min_x_m REAL NOT NULL,
  max_x_m REAL NOT NULL,
  min_y_m REAL NOT NULL,
  max_y_m REAL NOT NULL,
  min_z_m REAL NOT NULL,
  max_z_m REAL NOT NULL,
  moved_m REAL,
  motion BLOB NOT NULL,
  before BLOB NOT NULL,
  after BLOB NOT NULL
);

CREATE TABLE tracking (
  recording INTEGER NOT NULL REFERENCES recordings(id),
  frame INTEGER NOT NULL,
  timestamp_s REAL NOT NULL,
  status TEXT NOT NULL,
  details TEXT NOT NULL,
  PRIMARY KEY (recording, frame)
) WITHOUT ROWID;

CREATE TABLE entries (
  name TEXT PRIMARY KEY,
  bytes BLOB NOT NULL
) WITHOUT ROWID;
COMMIT;
)sql";
}

}  // namespace tofmap

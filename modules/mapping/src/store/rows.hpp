// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "database.hpp"

#include <string>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/mapping/surface_map.hpp>

namespace tofmap {

/// Largest width or height of an image.
inline constexpr int most_pixels = 1 << 14;

/// Number of columns of a pose: translation, quaternion, and the exact rotation matrix.
inline constexpr int pose_columns = 8;

/// Binds a pose from a column on: x_m, y_m, z_m, qx, qy, qz, qw, rotation.
void bind_pose(SQLite::Statement& statement, int first, const Pose& pose);

/// The pose from a column on, exact to the bit. The quaternion is not read: it is there for people.
Pose pose_in(SQLite::Statement& row, int first);

/// Binds numbers, which must stay where they are until the statement was executed.
void bind_numbers(SQLite::Statement& statement, int index, const double* numbers, int count);
void bind_numbers(SQLite::Statement& statement, int index, const float* numbers, int count);

/// Reads numbers that bind_numbers() stored. Throws InputError if there are more or fewer, or if
/// one is not finite.
void read_numbers(SQLite::Statement& row, int index, double* numbers, int count);
void read_numbers(SQLite::Statement& row, int index, float* numbers, int count);

/// A number that must be finite.
double number_in(SQLite::Statement& row, int index);

/// A coordinate in metres, of a plausible size.
double position_in(SQLite::Statement& row, int index);

/// An integer from `least` to `most`.
int integer_in(SQLite::Statement& row, int index, int least, int most);

/// A sensor as JSON, and back. Throws InputError if the camera is invalid (validate()), or if there
/// are more than eight modulation frequencies. There may be none: only maps of described recordings
/// (RoomMapper::describe_recording()) have them.
std::string sensor_json(const SensorModel& sensor);
SensorModel sensor_in(const std::string& json);

/// Options of the surface as JSON, and back. Throws InputError if one is out of its range.
std::string surface_options_json(const SurfaceMapOptions& options);
SurfaceMapOptions surface_options_in(const std::string& json);

}  // namespace tofmap

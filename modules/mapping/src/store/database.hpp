// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <SQLiteCpp/SQLiteCpp.h>

#include <tofmap/core/error.hpp>

namespace tofmap {

/// What to do about a map that is damaged.
inline constexpr const char* damage_remedy = "map the recordings again, or use a copy of the file";

/// What an error of SQLite means for a map file, with a remedy.
std::string told(const SQLite::Exception& error);

/// Runs `step`. If it throws an error of SQLite or InputError, throws InputError with the path of
/// the file before the message.
template <class Step>
auto naming_file(const std::filesystem::path& file, const Step& step) {
  return naming(file.string(), [&] {
    try {
      return step();
    } catch (const SQLite::Exception& error) {
      throw InputError(told(error));
    }
  });
}

/// A new database with the tables of a map, locked.
SQLite::Database create_database(const std::filesystem::path& file);

/// The database of a map. Throws InputError unless it is one, undamaged, and of a version that is
/// known. `is_locked`: for this process alone, to be written.
SQLite::Database open_database(const std::filesystem::path& file, bool is_locked);

/// Adds the tables that a map of an earlier version lacks. To be called in a transaction.
void bring_up_to_date(SQLite::Database& database);

/// Version of the format of a map.
int format_version(SQLite::Database& database);

/// Whether another process writes the file.
bool is_in_use(const std::filesystem::path& file);

/// Stores a checksum of all tables, which open_database() compares with them. The compressed clouds
/// are left out, since they have checksums of their own.
void seal(SQLite::Database& database);

/// Removes the checksum, before the tables are changed.
void unseal(SQLite::Database& database);

/// Binds bytes, which must stay where they are until the statement was executed.
void bind_bytes(SQLite::Statement& statement, int index, std::string_view bytes);

/// The bytes of a column, valid until the statement goes on.
std::string_view bytes_in(const SQLite::Column& column);

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "database.hpp"

#include "crc_sum.hpp"
#include "insertion.hpp"
#include "schema.hpp"

#include <array>
#include <cstdint>
#include <fstream>
#include <set>
#include <string>

#include <sqlite3.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace fs = std::filesystem;
namespace {

constexpr int wait_for_lock_ms = 2000;

constexpr const char* no_map = "is not a map of tofmap; give map.db, or the folder that holds it";
const std::string damaged_file = std::string("is damaged; ") + damage_remedy;

/// Whether a database was left by a process that was to write it: changes may then be in a second
/// file, the write-ahead log, and reading merges them. Byte 18 of the file says so.
bool has_write_ahead_log(const fs::path& file) {
  constexpr std::size_t place = 18;
  constexpr char with_log = 2;
  std::array<char, place + 1> header{};
  std::ifstream(file, std::ios::binary).read(header.data(), header.size());
  return header[place] == with_log;
}

void lock(SQLite::Database& database) {
  database.exec("PRAGMA locking_mode = EXCLUSIVE");
  database.exec("PRAGMA journal_mode = WAL");
  database.exec("PRAGMA synchronous = NORMAL");
  database.exec("BEGIN IMMEDIATE; COMMIT");
}

int number_of(SQLite::Database& database, const char* pragma) {
  return database.execAndGet(pragma).getInt();
}

void check_version(SQLite::Database& database) {
  if (number_of(database, "PRAGMA application_id") != map_application_id) {
    throw InputError(no_map);
  }
  const int version = format_version(database);
  if (version < 1) throw InputError(damaged_file);
  if (version > map_format_version) {
    throw InputError("is a map of version " + std::to_string(version) +
                     ", and this program reads versions up to " +
                     std::to_string(map_format_version) + "; install a newer version of tofmap");
  }
}

/// Names of the tables of a database.
std::set<std::string> tables_of(SQLite::Database& database) {
  std::set<std::string> names;
  SQLite::Statement rows(database, "SELECT name FROM sqlite_master WHERE type = 'table'");
  while (rows.executeStep()) names.insert(rows.getColumn(0).getString());
  return names;
}

/// Names of the tables that statements make.
std::set<std::string> tables_made_by(const std::string& statements) {
  // The tables that others refer to need not be there.
  SQLite::Database database(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database.exec(statements);
  return tables_of(database);
}

/// Throws InputError if a table of this version is missing, or if a trigger would change what is
/// written.
void check_schema(SQLite::Database& database) {
  std::set<std::string> missing = tables_made_by(map_schema());
  for (const std::string& later : tables_made_by(map_schema_since(format_version(database)))) {
    missing.erase(later);
  }
  for (const std::string& present : tables_of(database)) missing.erase(present);
  if (!missing.empty()) {
    throw InputError("has no table '" + *missing.begin() + "'; " + damage_remedy);
  }
  SQLite::Statement triggers(database, "SELECT name FROM sqlite_master WHERE type = 'trigger'");
  if (triggers.executeStep()) {
    throw InputError("has a trigger, '" + triggers.getColumn(0).getString() +
                     "', which would change what is written; drop it");
  }
}

/// Throws InputError if a page of the file, or a reference between tables, is damaged.
void check_integrity(SQLite::Database& database) {
  SQLite::Statement pages(database, "PRAGMA quick_check(1)");
  if (!pages.executeStep() || pages.getColumn(0).getString() != "ok") {
    throw InputError(damaged_file);
  }
  SQLite::Statement references(database, "PRAGMA foreign_key_check");
  if (references.executeStep()) {
    throw InputError("is damaged: table '" + references.getColumn(0).getString() +
                     "' refers to rows of '" + references.getColumn(2).getString() +
                     "' that do not exist");
  }
}

constexpr const char* checksum_name = "checksum";

/// A checksum of values. Each has its type and its length before it, so that no two rows of values
/// that differ have the same bytes.
class Checksum {
 public:
  void add(char type, std::string_view bytes) {
    const std::uint64_t length = bytes.size();
    sum_.add({&type, 1});
    sum_.add({reinterpret_cast<const char*>(&length), sizeof length});
    sum_.add(bytes);
  }

  void add(const SQLite::Column& column) {
    if (column.isNull()) {
      add('n', {});
    } else if (column.isFloat()) {
      const double number = column.getDouble();
      add('r', {reinterpret_cast<const char*>(&number), sizeof number});
    } else {
      add(column.isInteger() ? 'i' : column.isText() ? 't' : 'b', bytes_in(column));
    }
  }

  std::string text() const { return std::to_string(sum_.value()); }

 private:
  CrcSum sum_;
};

/// A checksum of all rows of the tables but that of the checksum itself.
std::string checksum_of(SQLite::Database& database) {
  Checksum checksum;
  SQLite::Statement tables(
      database, "SELECT name, sql FROM sqlite_schema WHERE type = 'table' ORDER BY name");
  while (tables.executeStep()) {
    const std::string table = tables.getColumn(0).getString();
    checksum.add('t', tables.getColumn(1).getString());
    SQLite::Statement row(database, table == "clouds"
                                        ? "SELECT keyframe, width_px, height_px FROM clouds"
                                        : "SELECT * FROM " + table);
    while (row.executeStep()) {
      if (table == "properties" && row.getColumn(0).getString() == checksum_name) continue;
      for (int i = 0; i < row.getColumnCount(); ++i) checksum.add(row.getColumn(i));
    }
  }
  return checksum.text();
}

/// Throws InputError if the file has a checksum that is not that of its tables.
void check_checksum(SQLite::Database& database) {
  SQLite::Statement row(database, "SELECT value FROM properties WHERE name = ?");
  row.bind(1, checksum_name);
  if (row.executeStep() && row.getColumn(0).getString() != checksum_of(database)) {
    throw InputError(
        "is damaged, or was changed by another program; map the recordings again, or use a copy of "
        "the file");
  }
}

}  // namespace

void seal(SQLite::Database& database) {
  unseal(database);
  Insertion row(database, "properties", 2);
  row.statement.bind(1, checksum_name);
  row.statement.bind(2, checksum_of(database));
  row.execute();
}

void unseal(SQLite::Database& database) {
  SQLite::Statement row(database, "DELETE FROM properties WHERE name = ?");
  row.bind(1, checksum_name);
  row.exec();
}

std::string told(const SQLite::Exception& error) {
  switch (error.getErrorCode()) {
    case SQLITE_NOTADB:
      return no_map;
    case SQLITE_CORRUPT:
      return damaged_file;
    case SQLITE_ERROR:  // a table is missing, or has other columns
      return std::string("is damaged (") + error.what() +
             "); map the recordings again, or use a copy of the file";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "is in use by another program that writes it; wait until that ends";
    case SQLITE_FULL:
      return "cannot be written: the disk is full";
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return "cannot be written; make the file and its folder writable";
    case SQLITE_CANTOPEN:
      return "cannot be opened; check the path and the permissions";
    default:
      return std::string("cannot be read or written (SQLite: ") + error.what() + ")";
  }
}

SQLite::Database create_database(const fs::path& file) {
  if (fs::exists(file)) throw InputError("exists already; choose another name");
  SQLite::Database database(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE,
                            wait_for_lock_ms);
  database.exec("PRAGMA page_size = 16384");
  lock(database);
  database.exec(map_schema());
  return database;
}

SQLite::Database open_database(const fs::path& file, bool is_locked) {
  if (!fs::exists(file)) throw InputError("does not exist; 'tofmap map' makes one");
  if (fs::is_directory(file)) throw InputError("is a folder; give the file map.db in it");
  if (!fs::is_regular_file(file)) throw InputError("is no file; give map.db");
  const bool may_write = is_locked || has_write_ahead_log(file);
  SQLite::Database database(
      file.string(), may_write ? SQLite::OPEN_READWRITE : SQLite::OPEN_READONLY, wait_for_lock_ms);
  if (may_write) database.exec("PRAGMA locking_mode = EXCLUSIVE");
  check_version(database);
  check_schema(database);
  check_integrity(database);
  check_checksum(database);
  if (is_locked) lock(database);
  return database;
}

int format_version(SQLite::Database& database) {
  return number_of(database, "PRAGMA user_version");
}

void bring_up_to_date(SQLite::Database& database) {
  database.exec(map_schema_since(format_version(database)));
}

bool is_in_use(const fs::path& file) {
  try {
    SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
    database.exec("BEGIN IMMEDIATE; ROLLBACK");
    return false;
  } catch (const SQLite::Exception& error) {
    return error.getErrorCode() == SQLITE_BUSY || error.getErrorCode() == SQLITE_LOCKED;
  }
}

void bind_bytes(SQLite::Statement& statement, int index, std::string_view bytes) {
  statement.bindNoCopy(index, bytes.data(), static_cast<int>(bytes.size()));
}

std::string_view bytes_in(const SQLite::Column& column) {
  const void* data = column.getBlob();
  return {static_cast<const char*>(data), static_cast<std::size_t>(column.getBytes())};
}

}  // namespace tofmap

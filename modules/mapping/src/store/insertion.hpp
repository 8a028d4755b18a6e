// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

namespace tofmap {

/// Puts rows into a table, in place of rows that have the same key. The values of a row are bound
/// to `statement`, by columns from 1 on; those that are not bound become null.
struct Insertion {
  Insertion(SQLite::Database& database, const std::string& table, int columns)
      : statement(database, text(table, columns)) {}

  /// Puts the row, and begins the next one.
  void execute() {
    statement.exec();
    statement.reset();
    statement.clearBindings();
  }

  SQLite::Statement statement;

 private:
  static std::string text(const std::string& table, int columns) {
    std::string sql = "INSERT OR REPLACE INTO " + table + " VALUES (?";
    for (int i = 1; i < columns; ++i) sql += ", ?";
    return sql + ")";
  }
};

}  // namespace tofmap

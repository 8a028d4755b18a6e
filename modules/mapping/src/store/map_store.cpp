// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/map_store.hpp"

#include "content_reader.hpp"
#include "content_writer.hpp"
#include "database.hpp"
#include "insertion.hpp"
#include "rows.hpp"

#include <limits>
#include <utility>

namespace tofmap {
namespace fs = std::filesystem;

struct MapStore::File {
  File(fs::path of, SQLite::Database opened) : path(std::move(of)), database(std::move(opened)) {}

  CompactCloud read_cloud(int keyframe) const;
  SurfaceMap read_surface(int submap, const SurfaceMapOptions& options) const;

  fs::path path;
  mutable SQLite::Database database;
  WrittenContent written;  ///< what the tables of the map hold
};

CompactCloud MapStore::File::read_cloud(int keyframe) const {
  return naming_file(path, [&] {
    SQLite::Statement row(database,
                          "SELECT width_px, height_px, points FROM clouds WHERE keyframe = ?");
    row.bind(1, keyframe);
    if (!row.executeStep()) {
      throw InputError("has no cloud of keyframe " + std::to_string(keyframe));
    }
    CompactCloud cloud{.width_px = integer_in(row, 0, 1, most_pixels),
                       .height_px = integer_in(row, 1, 1, most_pixels),
                       .bytes = {},
                       .origin = path.string() + ", keyframe " + std::to_string(keyframe)};
    const SQLite::Column points = row.getColumn(2);
    const std::string_view bytes = bytes_in(points);
    cloud.bytes.assign(bytes.begin(), bytes.end());
    return cloud;
  });
}

SurfaceMap MapStore::File::read_surface(int submap, const SurfaceMapOptions& options) const {
  return naming_file(path, [&] {
    SQLite::Statement row(database, "SELECT surface FROM submaps WHERE id = ?");
    row.bind(1, submap);
    if (!row.executeStep()) throw InputError("has no submap " + std::to_string(submap));
    const SQLite::Column surface = row.getColumn(0);
    return surface_from_bytes(bytes_in(surface), options);
  });
}

MapStore::MapStore(std::shared_ptr<File> file) : file_(std::move(file)) {}
MapStore::MapStore(MapStore&&) noexcept = default;
MapStore& MapStore::operator=(MapStore&&) noexcept = default;
MapStore::~MapStore() = default;

MapStore MapStore::create(const fs::path& file) {
  return naming_file(file,
                     [&] { return MapStore(std::make_shared<File>(file, create_database(file))); });
}

MapStore MapStore::open(const fs::path& file, Access access) {
  return naming_file(file, [&] {
    return MapStore(std::make_shared<File>(file, open_database(file, access == Access::extend)));
  });
}

bool MapStore::is_in_use(const fs::path& file) { return tofmap::is_in_use(file); }

MapContent MapStore::content() const {
  // Clouds and surfaces keep the file open as long as they may have to be read.
  const PartReaders readers{
      .cloud = [file = file_](int keyframe) { return file->read_cloud(keyframe); },
      .surface =
          [file = file_](int submap, const SurfaceMapOptions& options) {
            return file->read_surface(submap, options);
          }};
  MapContent content = naming_file(file_->path, [&] {
    try {
      return read_content(file_->database, readers);
    } catch (const InputError& error) {
      throw InputError(std::string(error.what()) + "; " + damage_remedy);
    }
  });
  file_->written = written(content);
  return content;
}

std::optional<std::string> MapStore::entry(const std::string& name) const {
  return naming_file(file_->path, [&]() -> std::optional<std::string> {
    SQLite::Statement row(file_->database, "SELECT bytes FROM entries WHERE name = ?");
    row.bind(1, name);
    if (!row.executeStep()) return std::nullopt;
    const SQLite::Column bytes = row.getColumn(0);
    return std::string(bytes_in(bytes));
  });
}

std::string MapStore::expected_entry(const std::string& name) const {
  auto bytes = entry(name);
  if (!bytes) throw InputError(file_->path.string() + ": '" + name + "' is missing");
  return *std::move(bytes);
}

std::function<std::string(const std::string& name)> MapStore::reader() const {
  return [file = file_](const std::string& name) { return MapStore(file).expected_entry(name); };
}

std::vector<std::string> MapStore::entries(const std::string& beginning) const {
  return naming_file(file_->path, [&] {
    std::vector<std::string> names;
    SQLite::Statement row(
        file_->database,
        "SELECT name FROM entries WHERE substr(name, 1, length(?1)) = ?1 ORDER BY name");
    row.bind(1, beginning);
    while (row.executeStep()) names.push_back(row.getColumn(0).getString());
    return names;
  });
}

std::vector<FrameRow> MapStore::frame_rows(int recording) const {
  return naming_file(file_->path, [&] {
    std::vector<FrameRow> rows;
    SQLite::Statement row(file_->database,
                          "SELECT * FROM tracking WHERE recording = ? ORDER BY frame");
    row.bind(1, recording);
    while (row.executeStep()) {
      rows.push_back({recording, integer_in(row, 1, 0, std::numeric_limits<int>::max()),
                      number_in(row, 2), row.getColumn(3).getString(),
                      row.getColumn(4).getString()});
    }
    return rows;
  });
}

struct MapStore::Commit::Open {
  explicit Open(SQLite::Database& database) : transaction(database) {}

  SQLite::Transaction transaction;
  std::optional<WrittenContent> written;
  // What can be read from the file after the commit, by its id.
  std::vector<std::pair<int, KeyframeCloud>> clouds;
  std::vector<std::pair<int, SubmapSurface>> surfaces;
  SurfaceMapOptions surface_options;
};

MapStore::Commit::Commit(MapStore& store) : store_(store) {
  naming_file(store_.file_->path, [&] {
    open_ = std::make_unique<Open>(store_.file_->database);
    unseal(store_.file_->database);
    bring_up_to_date(store_.file_->database);
  });
}

MapStore::Commit::~Commit() = default;

void MapStore::Commit::write(const MapContent& content) {
  naming_file(store_.file_->path, [&] {
    File& file = *store_.file_;
    open_->written = written(content);
    const StoredParts stored = write_content(content, file.written, *open_->written, file.database);
    for (const int id : stored.clouds) {
      open_->clouds.emplace_back(id, content.keyframes[id].cloud);
    }
    for (const int id : stored.submaps) {
      open_->surfaces.emplace_back(id, content.submaps[static_cast<std::size_t>(id)].surface);
    }
    open_->surface_options = content.surface_options;
  });
}

void MapStore::Commit::put(const std::string& name, std::string_view bytes) {
  naming_file(store_.file_->path, [&] {
    Insertion row(store_.file_->database, "entries", 2);
    row.statement.bind(1, name);
    bind_bytes(row.statement, 2, bytes);
    row.execute();
  });
}

void MapStore::Commit::remove(const std::string& beginning) {
  naming_file(store_.file_->path, [&] {
    SQLite::Statement row(store_.file_->database,
                          "DELETE FROM entries WHERE substr(name, 1, length(?1)) = ?1");
    row.bind(1, beginning);
    row.exec();
  });
}

void MapStore::Commit::put(std::span<const FrameRow> rows) {
  naming_file(store_.file_->path, [&] {
    Insertion row(store_.file_->database, "tracking", 5);
    for (const FrameRow& frame : rows) {
      row.statement.bind(1, frame.recording);
      row.statement.bind(2, frame.frame);
      row.statement.bind(3, frame.timestamp_s);
      row.statement.bind(4, frame.status);
      row.statement.bind(5, frame.details);
      row.execute();
    }
  });
}

void MapStore::Commit::finish() {
  naming_file(store_.file_->path, [&] { open_->transaction.commit(); });
  if (open_->written) store_.file_->written = std::move(*open_->written);
  for (const auto& [id, cloud] : open_->clouds) {
    cloud.put_aside([file = store_.file_, keyframe = id] { return file->read_cloud(keyframe); });
  }
  for (const auto& [id, surface] : open_->surfaces) {
    surface.put_aside([file = store_.file_, submap = id, options = open_->surface_options] {
      return file->read_surface(submap, options);
    });
  }
}

void MapStore::shrink() {
  naming_file(file_->path, [&] { file_->database.exec("VACUUM"); });
}

void MapStore::settle() {
  naming_file(file_->path, [&] {
    seal(file_->database);
    file_->database.exec("PRAGMA wal_checkpoint(TRUNCATE)");
    const SQLite::Column mode = file_->database.execAndGet("PRAGMA journal_mode = DELETE");
    if (mode.getString() != "delete") {
      throw InputError("cannot be completed: its write-ahead log stays beside it");
    }
    file_->database.exec("PRAGMA locking_mode = NORMAL");
    file_->database.execAndGet("SELECT COUNT(*) FROM recordings");  // releases the lock
  });
}

}  // namespace tofmap

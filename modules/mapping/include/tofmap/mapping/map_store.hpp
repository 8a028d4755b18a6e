// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tofmap/mapping/map_content.hpp>

namespace tofmap {

/// The name of the file of a map in a result folder.
inline constexpr const char* map_file_name = "map.db";

/// What became of a frame that was read from a recording, registered or not.
struct FrameRow {
  int recording = 0;  ///< index in MapContent::recordings
  int frame = 0;      ///< index in the recording
  double timestamp_s = 0;
  std::string status;   ///< how it was tracked, or that it is damaged
  std::string details;  ///< JSON
};

/// A map in a file (docs/map-format.md): an SQLite database that is consistent at any moment. A
/// process that is killed leaves what the last commit wrote. All functions throw InputError, which
/// names the file, if it cannot be read or written, or if what is in it is damaged.
class MapStore {
 public:
  enum class Access {
    read,    ///< several processes may read a map at the same time
    extend,  ///< locks the file against others
  };

  /// Makes a file for a new map, which must not exist yet, and locks it.
  static MapStore create(const std::filesystem::path& file);

  /// Opens the file of a map and checks that it is one, of a version that this program reads.
  static MapStore open(const std::filesystem::path& file, Access access = Access::read);

  /// Whether another process is writing a file.
  static bool is_in_use(const std::filesystem::path& file);

  MapStore(MapStore&&) noexcept;
  MapStore& operator=(MapStore&&) noexcept;
  ~MapStore();

  /// The map as of the last commit. Its clouds stay in the file until they are needed, so that the
  /// file must not be changed by others, but may be removed.
  MapContent content() const;

  /// What was stored under a name besides the map. Empty if nothing was.
  std::optional<std::string> entry(const std::string& name) const;

  /// The same, but throws if nothing was stored under the name.
  std::string expected_entry(const std::string& name) const;

  /// expected_entry() as a function that may be called after this object is gone.
  std::function<std::string(const std::string& name)> reader() const;

  /// The names of all entries that begin like this, in alphabetical order.
  std::vector<std::string> entries(const std::string& beginning) const;

  /// The rows of the frames of a recording, in order.
  std::vector<FrameRow> frame_rows(int recording) const;

  /// Changes of a map that are written together. Without finish(), none of them is.
  class Commit {
   public:
    explicit Commit(MapStore& store);
    Commit(const Commit&) = delete;
    Commit& operator=(const Commit&) = delete;
    ~Commit();

    /// Brings the file up to date with the map. What the file has already is not written again.
    /// After finish(), clouds and surfaces are read from the file when they are needed, but for the
    /// surface of the latest submap.
    void write(const MapContent& content);

    /// Stores bytes under a name, or replaces them.
    void put(const std::string& name, std::string_view bytes);

    /// Removes all entries whose names begin like this.
    void remove(const std::string& beginning);

    /// Stores the rows of frames. Rows of the same frame are replaced.
    void put(std::span<const FrameRow> rows);

    void finish();

   private:
    MapStore& store_;
    struct Open;
    std::unique_ptr<Open> open_;
  };

  /// Shrinks the file to what is in it.
  void shrink();

  /// Merges the write-ahead log into the file, which can then be moved and copied, and unlocks it.
  /// There must be no commit afterwards.
  void settle();

 private:
  struct File;
  explicit MapStore(std::shared_ptr<File> file);

  std::shared_ptr<File> file_;
};

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "input/map_input.hpp"
#include "output/output_folder.hpp"

#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <optional>
#include <vector>

#include <tofmap/mapping/map_store.hpp>
#include <tofmap/pipeline/frame_sample.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {

/// The file map.db of a result while the map is made. The run is stored every few seconds, so that
/// little is lost if the program is killed.
class MapFile {
 public:
  /// Makes the file of a new map in the temporary folder of a result. If that fails, the map is
  /// made without it, and complete() throws the exception.
  explicit MapFile(OutputFolder& out);

  /// Continues the file of the interrupted or killed run whose result was to be `folder`: a copy of
  /// it in the temporary folder of the new result. A new file, or extending() `onto` if that is not
  /// empty, if there is no such folder. Throws InputError if the folder holds no map, if the run
  /// does not go on with `onto`, or if it is still going on.
  static MapFile resumed(OutputFolder& out, const std::filesystem::path& folder,
                         const std::filesystem::path& onto);

  /// The file of a map that goes on with a finished one: a copy of `map`, a map file or the folder
  /// that holds it. Throws InputError if that cannot be read.
  static MapFile extending(OutputFolder& out, const std::filesystem::path& map);

  /// Takes the finished map to go on with. Empty if the file is new, or that of an interrupted run.
  std::optional<MapContent> to_extend();

  /// The options of the surface of the finished map that the file goes on with, which stay as they
  /// are. Empty if there is none.
  std::optional<SurfaceMapOptions> surface_options() const { return surface_options_; }

  /// The verdict on the finished map that the file goes on with. Empty if there is none.
  std::optional<Verdict> verdict_before() const { return verdict_before_; }

  /// The file of an interrupted or killed run, which resume_run() continues. Null if the file is
  /// new.
  const MapStore* to_resume() const { return is_resumed_ ? &*store_ : nullptr; }

  /// Stores a run if enough time has passed: at least half a second, and twenty times what storing
  /// took; or four times that, if submaps take much memory that storing frees. If that fails, and
  /// the run can be resumed from what was stored before, throws InputError, which says where that
  /// is kept. Otherwise the map is made without the file.
  void store_if_due(MapRun& run, FrameSample& sample, MapInput& input,
                    const PipelineOptions& options);

  /// Stores a run that has read its last frame, so that a recording can be resumed from it. If that
  /// fails, the map is made without the file, or with what was stored before.
  void store_last(MapRun& run, FrameSample& sample, MapInput& input,
                  const PipelineOptions& options);

  /// Ends the file: stores the map of a run that was finished, unless it may be resumed
  /// (`is_interrupted`), and merges what SQLite keeps beside the file into it. If that fails,
  /// or something failed before, removes the file and throws the exception.
  void complete(MapRun& run, bool is_interrupted);

  /// Removes the file: the result gets none.
  void discard();

 private:
  using Clock = std::chrono::steady_clock;

  MapFile(OutputFolder& out, std::optional<MapStore> store,
          std::vector<std::filesystem::path> killed, bool is_resumed);

  void note_base(const MapContent& content, std::size_t recordings);
  void store(MapRun& run, FrameSample& sample, MapInput& input, const PipelineOptions& options);
  void remove_killed();
  void give_up();

  OutputFolder* out_;
  /// Folders that killed runs left, until the map is stored in the new file.
  std::vector<std::filesystem::path> killed_;
  std::optional<MapStore> store_;       ///< empty if it could not be written
  std::exception_ptr failure_;          ///< why
  std::optional<MapContent> finished_;  ///< until to_extend()
  std::optional<SurfaceMapOptions> surface_options_;
  std::optional<Verdict> verdict_before_;
  bool is_resumed_;            ///< whether the file is that of an interrupted run
  bool is_stored_;             ///< whether there was a commit
  Clock::time_point soonest_;  ///< nothing is stored before this time
  Clock::time_point due_;      ///< the run is stored at this time, however little memory it takes
};

/// Prints a note if a killed run has left its map beside a result.
void tell_of_killed_run(const std::filesystem::path& folder);

}  // namespace tofmap::app

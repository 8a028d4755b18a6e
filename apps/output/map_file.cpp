// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/map_file.hpp"

#include "input/map_argument.hpp"

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tofmap/core/error.hpp>
#include <tofmap/pipeline/run_store.hpp>

namespace tofmap::app {
namespace fs = std::filesystem;
namespace {

constexpr std::chrono::milliseconds shortest_interval(500);
constexpr int intervals_of_its_duration = 20;
constexpr int least_intervals_of_its_duration = 4;  // if submaps take much memory
/// Number of voxels in memory that make storing due. They take about 120 MB.
constexpr std::size_t most_voxels_at_rest = 1'500'000;

/// The temporary folders of a result that hold the map of a killed or running program, the newest
/// first.
std::vector<fs::path> left_folders(const fs::path& folder) {
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(fs::absolute(folder), error);
  if (error) return {};
  const std::string beginning = absolute.filename().string() + OutputFolder::partial_suffix;
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(absolute.parent_path(), error)) {
    if (entry.path().filename().string().starts_with(beginning) &&
        fs::is_regular_file(entry.path() / map_file_name, error)) {
      left.push_back(entry.path());
    }
  }
  std::ranges::sort(left, std::ranges::greater(), [&](const fs::path& path) {
    return fs::last_write_time(path / map_file_name, error);
  });
  return left;
}

/// What killed runs have left beside a result.
struct KilledRuns {
  std::vector<fs::path> folders;   ///< of which nothing is needed once a new file holds more
  std::optional<fs::path> newest;  ///< the newest one that can be continued
};

/// Looks through the temporary folders of a result, and merges what killed programs have left
/// beside their files. A folder with more than the file is a result that could not be moved into
/// place. It stays, as does a folder whose file cannot be read, which is named. Throws InputError
/// if a run is still going on.
KilledRuns killed_runs(const fs::path& folder, const OutputFolder& own) {
  KilledRuns killed;
  for (const fs::path& left : left_folders(folder)) {
    if (left == own.path()) continue;
    const fs::path file = left / map_file_name;
    if (MapStore::is_in_use(file)) {
      throw InputError(file.string() +
                       ": is in use by a run that is still going on; wait until it ends, or give "
                       "another --out");
    }
    try {
      MapStore store = MapStore::open(file, MapStore::Access::extend);
      const bool holds = holds_run(store);
      store.settle();
      if (!holds && fs::exists(left / "trajectory.txt")) continue;
      killed.folders.push_back(left);
      if (holds && !killed.newest) killed.newest = left;
    } catch (const InputError& error) {
      std::fprintf(stderr, "tofmap: left out, remove it if it is not needed: %s\n", error.what());
    }
  }
  return killed;
}

/// The map file of an interrupted run.
fs::path interrupted_file(const fs::path& folder) {
  const fs::path file = folder / map_file_name;
  if (!fs::is_regular_file(file)) {
    throw InputError(
        folder.string() +
        ": holds no interrupted run that could be resumed; start anew without --resume");
  }
  return file;
}

fs::path copied(const fs::path& file, const fs::path& copy) {
  std::error_code error;
  fs::copy_file(file, copy, error);
  if (error) {
    throw InputError(copy.string() + ": cannot be written (" + error.message() +
                     "); is the disk full?");
  }
  fs::permissions(copy, fs::perms::owner_write, fs::perm_options::add, error);
  return copy;
}

/// Throws InputError unless an interrupted run, of which these are the recordings, goes on with the
/// finished map `onto`, or with none if that is empty.
void check_base(const std::vector<MapRecording>& recordings, const fs::path& onto) {
  std::vector<MapRecording> base;
  if (!onto.empty()) base = MapStore::open(map_file_in(onto)).content().recordings;
  const auto is_same = [](const MapRecording& one, const MapRecording& other) {
    return one.source == other.source && one.added == other.added;
  };
  if (std::ranges::equal(std::span(recordings).first(recordings.size() - 1), base, is_same)) return;
  throw InputError(onto.empty() ? "the interrupted run extends a map, which --onto must name"
                                : "the interrupted run does not extend " + onto.string() +
                                      " as it is now; it extends another map, or that has been "
                                      "extended since");
}

/// Number of voxels in memory that need not stay there once the map is stored.
std::size_t voxels_at_rest(const MapContent& content) {
  std::size_t voxels = 0;
  for (const int submap : submaps_at_rest(content)) {
    voxels += content.submaps[static_cast<std::size_t>(submap)].surface.size();
  }
  return voxels;
}

std::optional<Verdict> verdict_named(const std::string& name) {
  for (const Verdict verdict : {Verdict::good, Verdict::check, Verdict::bad}) {
    if (name_of(verdict) == name) return verdict;
  }
  return std::nullopt;
}

}  // namespace

MapFile::MapFile(OutputFolder& out, std::optional<MapStore> store, std::vector<fs::path> killed,
                 bool is_resumed)
    : out_(&out),
      killed_(std::move(killed)),
      store_(std::move(store)),
      is_resumed_(is_resumed),
      is_stored_(is_resumed),
      soonest_(Clock::now() + shortest_interval),
      due_(soonest_) {}

MapFile::MapFile(OutputFolder& out) : MapFile(out, std::nullopt, {}, false) {
  try {
    store_ = MapStore::create(out.path() / map_file_name);
  } catch (const InputError&) {
    give_up();
  }
}

MapFile MapFile::resumed(OutputFolder& out, const fs::path& folder, const fs::path& onto) {
  KilledRuns killed = killed_runs(folder, out);
  if (!killed.newest && !fs::exists(folder)) {
    MapFile file = onto.empty() ? MapFile(out) : extending(out, onto);
    file.killed_ = std::move(killed.folders);
    return file;
  }
  const fs::path interrupted =
      killed.newest ? *killed.newest / map_file_name : interrupted_file(folder);
  const fs::path copy = copied(interrupted, out.path() / map_file_name);
  try {
    MapFile file(out, MapStore::open(copy, MapStore::Access::extend), std::move(killed.folders),
                 true);
    const MapContent content = file.store_->content();
    check_base(content.recordings, onto);
    file.note_base(content, content.recordings.size() - 1);
    return file;
  } catch (const InputError& error) {
    throw InputError(std::string(error.what()) + "; start anew without --resume");
  }
}

MapFile MapFile::extending(OutputFolder& out, const fs::path& map) {
  const fs::path file = map_file_in(map);
  MapStore::open(file);  // with messages that name it, not its copy
  const fs::path copy = copied(file, out.path() / map_file_name);
  MapFile extended(out, MapStore::open(copy, MapStore::Access::extend), {}, false);
  extended.finished_ = extended.store_->content();
  extended.note_base(*extended.finished_, extended.finished_->recordings.size());
  return extended;
}

/// Notes what the map was like after its first recordings.
void MapFile::note_base(const MapContent& content, std::size_t recordings) {
  if (recordings == 0) return;
  surface_options_ = content.surface_options;
  verdict_before_ = verdict_named(content.recordings[recordings - 1].verdict);
}

std::optional<MapContent> MapFile::to_extend() { return std::exchange(finished_, std::nullopt); }

void MapFile::store(MapRun& run, FrameSample& sample, MapInput& input,
                    const PipelineOptions& options) {
  if (input.is_recording()) {
    store_run(*store_, run, sample, *input.recording(), options);
  } else {
    store_map(*store_, run);
  }
  is_stored_ = true;
  remove_killed();
}

/// Removes what killed runs have left, now that the file holds more.
void MapFile::remove_killed() {
  std::error_code ignored;
  for (const fs::path& killed : killed_) fs::remove_all(killed, ignored);
  killed_.clear();
}

void MapFile::store_if_due(MapRun& run, FrameSample& sample, MapInput& input,
                           const PipelineOptions& options) {
  if (!store_ || run.frames().empty()) return;
  const Clock::time_point start = Clock::now();
  const bool is_large = voxels_at_rest(run.mapper().content()) > most_voxels_at_rest;
  if (start < (is_large ? soonest_ : due_)) return;
  try {
    store(run, sample, input, options);
  } catch (const InputError& error) {
    if (!input.is_recording() || !is_stored_) {
      give_up();
      return;
    }
    out_->keep();
    throw InputError(std::string(error.what()) +
                     "; what was mapped before is kept there, and --resume continues from it");
  }
  const Clock::time_point end = Clock::now();
  soonest_ = end + std::max<Clock::duration>(shortest_interval,
                                             least_intervals_of_its_duration * (end - start));
  due_ = std::max(soonest_, end + intervals_of_its_duration * (end - start));
}

void MapFile::store_last(MapRun& run, FrameSample& sample, MapInput& input,
                         const PipelineOptions& options) {
  if (!store_) return;
  try {
    store(run, sample, input, options);
  } catch (const InputError&) {
    if (input.is_recording() && is_stored_) {
      out_->keep();  // what was stored before is there, should the result not become complete
    } else {
      give_up();
    }
  }
}

void MapFile::complete(MapRun& run, bool is_interrupted) {
  if (!store_) std::rethrow_exception(failure_);
  try {
    if (!is_interrupted) complete_map(*store_, run);
    store_->settle();
    remove_killed();
  } catch (const std::exception&) {
    give_up();
    throw;
  }
}

/// Goes on without the file, because of the exception that is being handled.
void MapFile::give_up() {
  failure_ = std::current_exception();
  discard();
}

void MapFile::discard() {
  store_.reset();
  std::error_code ignored;
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) {
    fs::remove(out_->path() / (std::string(map_file_name) + suffix), ignored);
  }
}

void tell_of_killed_run(const fs::path& folder) {
  const std::vector<fs::path> left = left_folders(folder);
  if (left.empty()) return;
  std::fprintf(stderr,
               "tofmap: %s holds the map of a run that was killed or is still going on; --resume "
               "continues a killed one\n",
               left.front().c_str());
}

}  // namespace tofmap::app

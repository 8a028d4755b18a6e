// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/map_argument.hpp"
#include "options/options.hpp"
#include "output/change_report.hpp"
#include "output/json_text.hpp"
#include "output/output_folder.hpp"
#include "output/refusal.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/mapping/map_merge.hpp>
#include <tofmap/mapping/map_store.hpp>
#include <tofmap/mapping/mesh_extraction.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

struct MergeArguments {
  std::vector<std::filesystem::path> maps;
  std::filesystem::path out;
  CommonArguments common;
};

/// The maps to merge, and the files that they are from.
struct MergeInput {
  std::vector<MapStore> files;
  std::vector<MapContent> maps;
};

MergeInput read_maps(const std::vector<std::filesystem::path>& paths,
                     const std::filesystem::path& out) {
  if (paths.size() < 2) throw UsageError("merge: needs at least two maps");
  MergeInput input;
  for (const std::filesystem::path& path : paths) {
    const std::filesystem::path file = map_file_in(path);
    refuse_to_replace(file, out);
    input.files.push_back(MapStore::open(file));
    input.maps.push_back(input.files.back().content());
  }
  return input;
}

/// How the frames of the merged recordings were tracked, from the files of the maps.
std::vector<FrameRow> tracking_of(const MergeInput& input, const MergedMaps& merged,
                                  const std::vector<std::vector<MapRecording>>& recordings) {
  std::vector<FrameRow> rows;
  for (std::size_t i = 0; i < input.files.size(); ++i) {
    if (!merged.is_joined[i]) continue;
    for (std::size_t old = 0; old < recordings[i].size(); ++old) {
      const auto place =
          std::ranges::find_if(merged.content.recordings, [&](const MapRecording& recording) {
            return recording.source == recordings[i][old].source &&
                   recording.added == recordings[i][old].added;
          });
      for (FrameRow row : input.files[i].frame_rows(static_cast<int>(old))) {
        row.recording = static_cast<int>(place - merged.content.recordings.begin());
        rows.push_back(std::move(row));
      }
    }
  }
  return rows;
}

Json report_json(const MergeArguments& arguments, const MergedMaps& merged, int map) {
  Json report;
  const MapContent& content = merged.content;
  report["summary"] = {
      {"maps", arguments.maps.size()},
      {"joined", std::ranges::count(merged.is_joined, true)},
      {"recordings", content.recordings.size()},
      {"keyframes", std::ranges::count(content.keyframes.all(), map, &Keyframe::map)}};
  report["maps"] = Json::array();
  for (std::size_t i = 0; i < arguments.maps.size(); ++i) {
    const MapNearness& nearness = merged.nearness[i];
    report["maps"].push_back({{"path", arguments.maps[i].string()},
                              {"joined", bool{merged.is_joined[i]}},
                              {"keyframes", nearness.keyframes},
                              {"recognised", nearness.recognised},
                              {"agreeing", nearness.agreeing},
                              {"ambiguous", nearness.obstacle == JoinObstacle::ambiguous}});
  }
  report["changes"] = changes_json(content.changes, content.recordings);
  return report;
}

/// The path of each recording in the merged map: trajectory_1.txt, trajectory_2.txt, …
void write_paths(const OutputFolder& out, const MapContent& content, int map) {
  for (int i = 0; i < std::ssize(content.recordings); ++i) {
    write_trajectory(out.path() / fmt::format("trajectory_{}.txt", i + 1),
                     trajectory_of(content, map, i));
  }
  write_trajectory(out.path() / "keyframes.txt", all_keyframes_of(content, map));
}

void write_map_file(const OutputFolder& out, const MapContent& content,
                    const std::vector<FrameRow>& tracking) {
  MapStore store = MapStore::create(out.path() / map_file_name);
  {
    MapStore::Commit commit(store);
    commit.write(content);
    commit.put(tracking);
    commit.finish();
  }
  store.settle();
}

int run_merge(const MergeArguments& arguments) {
  ProgramOptions options;
  const OptionTable table = arguments.common.resolve("merge", options);
  MergeInput input = read_maps(arguments.maps, arguments.out);
  std::vector<std::vector<MapRecording>> recordings;
  for (const MapContent& map : input.maps) recordings.push_back(map.recordings);
  OutputFolder out(arguments.out);
  const bool quiet = arguments.common.quiet;
  Progress progress("comparing map", static_cast<int>(arguments.maps.size()), quiet);
  const OdometryOptions& odometry = options.pipeline.odometry;
  const MergedMaps merged = merge_maps(
      std::move(input.maps), {odometry.keyframe_translation_m, odometry.keyframe_rotation_rad},
      options.pipeline.loops, options.pipeline.registration, [&](std::size_t i) {
        stop_if_interrupted();
        progress.show(static_cast<int>(i));
      });
  const bool is_any_joined = std::ranges::count(merged.is_joined, true) > 1;
  for (std::size_t i = 0; i < arguments.maps.size(); ++i) {
    if (merged.is_joined[i]) continue;
    std::fprintf(stderr, "tofmap: left out: %s: %s\n", arguments.maps[i].c_str(),
                 told_nearness(merged.nearness[i]).c_str());
  }
  if (!is_any_joined) {
    throw InputError("none of the maps fits the first one, " + arguments.maps.front().string() +
                     "; merge maps that show a part of the same building from similar places");
  }
  const MapContent& content = merged.content;
  const int map = largest_map(content);
  const MapCloud surface = surface_of(content, map);
  write_map(out.path() / "map.ply", surface);
  write_mesh(out.path() / "mesh.ply", extract_mesh(surface, content.surface_options.voxel_m));
  write_paths(out, content, map);
  write_map_file(out, content, tracking_of(input, merged, recordings));
  if (!content.changes.empty()) write_changes(out.path() / changes_file_name, content.changes);
  out.write_text("report.json", json_text(report_json(arguments, merged, map)));
  out.write_text("options.yaml", table.to_yaml(false));
  out.commit();
  if (!quiet) {
    std::printf("%td of %zu maps merged, %zu map points\n",
                std::ranges::count(merged.is_joined, true), arguments.maps.size(), surface.size());
    print_changes(content.changes, content.recordings);
    std::printf("map: %s, map.db beside it\n", (out.final_path() / "map.ply").c_str());
  }
  return exit_status::done;
}

}  // namespace

void add_merge_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<MergeArguments>();
  CLI::App* app = program.add_subcommand("merge", "join maps of one building");
  app->add_option("MAP", arguments->maps, "folders that 'map' or 'merge' wrote, or map.db files")
      ->required();
  app->add_option("--out", arguments->out, "folder for the result")->required();
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_merge(*arguments); });
}

}  // namespace tofmap::app

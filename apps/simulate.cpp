// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "interruption.hpp"
#include "options.hpp"
#include "output_folder.hpp"
#include "progress.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>

#include <CLI/CLI.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/acquisition/simulator.hpp>
#include <tofmap/acquisition/tum_recording.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace {

struct SimulateArguments {
  std::string scene;
  std::filesystem::path tum;
  std::filesystem::path out;
  std::string seed;
  std::string frames;
  CommonArguments common;
};

/// What is recorded, and how: frame after frame is written, until keep_going(done) says no.
struct Recording {
  int frame_count = 0;
  std::string name;
  std::function<int(const std::filesystem::path& folder,
                    const std::function<bool(int done)>& keep_going)>
      write;
};

Recording simulated(const std::string& scene, const ProgramOptions& options) {
  auto simulator = std::make_shared<const Simulator>(find_scene(scene, options.simulator.seed),
                                                     options.simulator);
  return {*simulator->frame_count(), scene,
          [simulator](const std::filesystem::path& folder, const auto& keep_going) {
            return simulate_sequence(*simulator, folder,
                                     [&](int done, int) { return keep_going(done); });
          }};
}

Recording wrapped_again(const std::filesystem::path& folder, const ProgramOptions& options) {
  auto source = std::make_shared<const TumRecording>(folder, options.tum, options.simulator);
  const int wanted = options.simulator.frames;
  const int count = wanted > 0 ? std::min(wanted, source->frame_count()) : source->frame_count();
  return {count, folder.string(),
          [source, count](const std::filesystem::path& out, const auto& keep_going) {
            SequenceWriter writer(out, source->sensor());
            for (int i = 0; i < count && keep_going(i); ++i) {
              const TumRecording::Frame frame = source->read(i);
              writer.add(frame.frame, frame.world_from_camera, frame.range_truth_m);
            }
            return writer.count();
          }};
}

int run_simulate(const SimulateArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("simulate", options);
  if (!arguments.seed.empty()) table.set("simulator.seed", arguments.seed);
  if (!arguments.frames.empty()) table.set("simulator.frames", arguments.frames);
  if (arguments.scene.empty() == arguments.tum.empty()) {
    throw UsageError("simulate takes a SCENE, or --from-tum DIR");
  }
  const Recording recording = arguments.tum.empty() ? simulated(arguments.scene, options)
                                                    : wrapped_again(arguments.tum, options);
  OutputFolder out(arguments.out, Replaces::recordings);
  int written = 0;
  {
    Progress progress("simulating frame", recording.frame_count, arguments.common.quiet);
    written = recording.write(out.path(), [&](int done) {
      progress.show(done);
      return !is_interrupted();
    });
  }
  out.write_text("options.yaml", table.to_yaml(false));
  out.commit();
  if (!arguments.common.quiet) {
    std::printf("%d of %d frames of '%s' simulated: %s\n", written, recording.frame_count,
                recording.name.c_str(), out.final_path().c_str());
  }
  return written < recording.frame_count ? exit_status::interrupted : exit_status::done;
}

}  // namespace

void add_simulate_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* app = program.add_subcommand("simulate", "record a simulated camera in a scene");
  app->add_option("SCENE", arguments->scene, "a built-in scene, or a PLY or OBJ mesh");
  app->add_option("--from-tum", arguments->tum,
                  "instead of a scene: a recording of the TUM RGB-D benchmark, whose depth is "
                  "wrapped");
  app->add_option("--out", arguments->out, "folder for the recording")->required();
  app->add_option("--seed", arguments->seed, "seed of the noise");
  app->add_option("--frames", arguments->frames, "how many frames, 0: the scene's own");
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_simulate(*arguments); });
}

}  // namespace tofmap::app

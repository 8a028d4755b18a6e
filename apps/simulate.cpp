// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "interruption.hpp"
#include "options.hpp"
#include "output_folder.hpp"
#include "progress.hpp"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include <tofmap/acquisition/simulator.hpp>

namespace tofmap::app {
namespace {

struct SimulateArguments {
  std::string scene;
  std::filesystem::path out;
  std::string seed;
  std::string frames;
  CommonArguments common;
};

int run_simulate(const SimulateArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("simulate", options);
  if (!arguments.seed.empty()) table.set("simulator.seed", arguments.seed);
  if (!arguments.frames.empty()) table.set("simulator.frames", arguments.frames);

  const Simulator simulator(find_scene(arguments.scene, options.simulator.seed), options.simulator);
  OutputFolder out(arguments.out, Replaces::recordings);
  const int total = *simulator.frame_count();
  int written = 0;
  {
    Progress progress("simulating frame", total, arguments.common.quiet);
    written = simulate_sequence(simulator, out.path(), [&](int done, int) {
      progress.show(done);
      return !is_interrupted();
    });
  }
  out.write_text("options.yaml", table.to_yaml(false));
  out.commit();
  if (!arguments.common.quiet) {
    std::printf("%d of %d frames of '%s' simulated: %s\n", written, total, arguments.scene.c_str(),
                out.final_path().c_str());
  }
  return written < total ? exit_status::interrupted : exit_status::done;
}

}  // namespace

void add_simulate_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* app = program.add_subcommand("simulate", "record a simulated camera in a scene");
  app->add_option("SCENE", arguments->scene, "a built-in scene, or a PLY or OBJ mesh")->required();
  app->add_option("--out", arguments->out, "folder for the recording")->required();
  app->add_option("--seed", arguments->seed, "seed of the noise");
  app->add_option("--frames", arguments->frames, "how many frames, 0: the scene's own");
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_simulate(*arguments); });
}

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "options/options.hpp"
#include "output/output_folder.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <span>

#include <CLI/CLI.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/named_value.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/simulation/kinect2_recording.hpp>
#include <tofmap/simulation/simulator.hpp>
#include <tofmap/simulation/tum_recording.hpp>

namespace tofmap::app {
namespace {

/// What a recording is written as.
enum class RecordingFormat : std::uint8_t {
  sequence,  ///< the sequence format
  kinect2,   ///< packets of a Kinect v2
};

std::span<const NamedValue<RecordingFormat>> named_values(RecordingFormat) {
  static constexpr std::array<NamedValue<RecordingFormat>, 2> values{
      {{"sequence", RecordingFormat::sequence}, {"kinect2", RecordingFormat::kinect2}}};
  return values;
}

struct SimulateArguments {
  std::string scene;
  std::filesystem::path tum;
  std::string format = "sequence";
  std::filesystem::path out;
  std::string seed;
  std::string frames;
  CommonArguments common;
};

/// How many frames were written, and which were not.
struct Written {
  int frames = 0;
  std::vector<std::string> left_out = {};  ///< reasons why frames could not be made
};

/// A recording to be made. `write` writes its frames into a folder until all are written or
/// `keep_going`, which gets the number of frames done, returns false.
struct Recording {
  int frame_count = 0;
  std::string name;
  std::function<Written(const std::filesystem::path& folder,
                        const std::function<bool(int done)>& keep_going)>
      write;
};

/// Says which people, doors and pieces of furniture found no place in the scene.
void print_missing(const Simulator& simulator, const SimulatorOptions& wanted) {
  const auto print = [](int there, int asked, const char* what, const char* lacking) {
    if (there == asked) return;
    std::fprintf(stderr, "tofmap: %d of %d %s found a place: %s\n", there, asked, what, lacking);
  };
  print(simulator.bodies().people_count(), wanted.people, "people",
        "the scene lacks free floor that the camera sees");
  print(static_cast<int>(simulator.bodies().doors().size()), wanted.doors, "doors",
        "the scene lacks walls that the camera sees, with space for a door");
  const int rearranged = rearranged_count(simulator.furniture());
  if (rearranged == wanted.rearranged) return;
  std::fprintf(
      stderr,
      "tofmap: %d of %d pieces of furniture were rearranged: the scene lacks furniture and "
      "free floor that the camera sees\n",
      rearranged, wanted.rearranged);
}

Recording simulated(const std::string& scene, RecordingFormat format,
                    const ProgramOptions& options) {
  auto simulator =
      std::make_shared<const Simulator>(find_scene(scene, options.simulator.seed),
                                        options.simulator, [] { return !is_interrupted(); });
  print_missing(*simulator, options.simulator);
  if (format == RecordingFormat::kinect2) {
    check_fits_packets(simulator->sensor());
    return {*simulator->frame_count(), scene,
            [simulator, seed = options.simulator.errors_seed](const std::filesystem::path& folder,
                                                              const auto& keep_going) {
              return Written{simulate_kinect2(*simulator, seed, folder,
                                              [&](int done, int) { return keep_going(done); })};
            }};
  }
  return {*simulator->frame_count(), scene,
          [simulator](const std::filesystem::path& folder, const auto& keep_going) {
            return Written{simulate_sequence(*simulator, folder,
                                             [&](int done, int) { return keep_going(done); })};
          }};
}

/// Writes the first `count` frames of a TUM recording. Frames whose images cannot be read are left
/// out.
Written write_wrapped(const TumRecording& source, int count, const std::filesystem::path& folder,
                      const std::function<bool(int done)>& keep_going) {
  SequenceWriter writer(folder, source.sensor());
  Written written;
  written.left_out = source.left_out();
  for (int i = 0; i < count && keep_going(i); ++i) {
    std::optional<TumRecording::FrameWithTruth> frame;
    try {
      frame = source.read(i);
    } catch (const InputError& error) {
      written.left_out.emplace_back(error.what());
      continue;
    }
    writer.add(frame->frame, frame->world_from_camera, frame->range_truth_m);
  }
  written.frames = writer.count();
  return written;
}

Recording wrapped_again(const std::filesystem::path& folder, const ProgramOptions& options) {
  auto source = std::make_shared<const TumRecording>(folder, options.tum, options.simulator);
  const int wanted = options.simulator.frames;
  const int count = wanted > 0 ? std::min(wanted, source->frame_count()) : source->frame_count();
  if (!source->damaged_poses().empty()) {
    std::fprintf(stderr, "tofmap: %s left out; the first: %s\n",
                 counted(source->damaged_poses().size(), "pose").c_str(),
                 source->damaged_poses().front().c_str());
  }
  const int lost = static_cast<int>(source->left_out().size());
  return {count + lost, folder.string(),
          [source, count](const std::filesystem::path& out, const auto& keep_going) {
            return write_wrapped(*source, count, out, keep_going);
          }};
}

int run_simulate(const SimulateArguments& arguments) {
  const RecordingFormat format =
      find_named<RecordingFormat>(arguments.format).value_or(RecordingFormat::sequence);
  ProgramOptions options;
  if (format == RecordingFormat::kinect2) options.simulator = kinect2_simulator_options();
  OptionTable table = arguments.common.resolve("simulate", options);
  if (!arguments.seed.empty()) table.set("simulator.seed", arguments.seed);
  if (!arguments.frames.empty()) table.set("simulator.frames", arguments.frames);
  if (arguments.scene.empty() == arguments.tum.empty()) {
    throw UsageError("simulate needs either a SCENE or --from-tum DIR");
  }
  if (format == RecordingFormat::kinect2 && !arguments.tum.empty()) {
    throw UsageError(
        "--format kinect2 needs a SCENE: a packet holds 512 x 424 pixels, which images of "
        "--from-tum do not have");
  }
  const Recording recording = arguments.tum.empty() ? simulated(arguments.scene, format, options)
                                                    : wrapped_again(arguments.tum, options);
  OutputFolder out(arguments.out, Replaces::recordings);
  Written written;
  {
    Progress progress("simulating frame", recording.frame_count, arguments.common.quiet);
    written = recording.write(out.path(), [&](int done) {
      progress.show(done);
      return !is_interrupted();
    });
  }
  if (written.frames == 0 && !written.left_out.empty()) {
    throw InputError("no frame could be made: " + written.left_out.front());
  }
  out.write_text("options.yaml", table.to_yaml(false));
  const bool is_whole =
      written.frames + static_cast<int>(written.left_out.size()) == recording.frame_count;
  out.commit(is_whole ? Completeness::whole : Completeness::interrupted);
  if (!written.left_out.empty()) {
    std::fprintf(stderr, "tofmap: %s left out; the first: %s\n",
                 counted(written.left_out.size(), "frame").c_str(),
                 written.left_out.front().c_str());
  }
  if (!arguments.common.quiet) {
    std::printf("%d of %d frames of '%s' simulated: %s\n", written.frames, recording.frame_count,
                recording.name.c_str(), out.final_path().c_str());
  }
  return is_whole ? exit_status::done : exit_status::interrupted;
}

}  // namespace

void add_simulate_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* app =
      program.add_subcommand("simulate", "make a recording of a simulated camera in a scene");
  app->add_option("SCENE", arguments->scene, "name of a built-in scene, or a PLY or OBJ mesh file");
  app->add_option("--from-tum", arguments->tum,
                  "use the depth images of a TUM RGB-D benchmark recording instead of a scene");
  app->add_option("--out", arguments->out, "folder for the recording")->required();
  app->add_option(
         "--format", arguments->format,
         "sequence: the format that all commands read; kinect2: packets of a Kinect v2 for "
         "'tofmap import kinect2' and other programs, with the truth beside them")
      ->check(CLI::IsMember({"sequence", "kinect2"}))
      ->default_str("sequence");
  app->add_option("--seed", arguments->seed, "seed of the random noise");
  app->add_option("--frames", arguments->frames,
                  "number of frames; 0: the default of the scene, or all of the TUM recording");
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_simulate(*arguments); });
}

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "options/options.hpp"
#include "views/viewed.hpp"

#include <chrono>
#include <cstdio>
#include <memory>
#include <set>
#include <thread>

#include <CLI/CLI.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/unwrap/unwrap.hpp>
#include <tofmap/visualization/window.hpp>

namespace tofmap::app {
namespace {

struct ViewArguments {
  ViewRequest request;
  std::filesystem::path screenshot;
  std::string from = "outside";
  int width_px = 1280;
  int height_px = 800;
  CommonArguments common;

  double aspect() const { return static_cast<double>(width_px) / height_px; }
};

/// The window that shows a Viewed, with its keys.
class ViewWindow {
 public:
  ViewWindow(Viewed& viewed, const ViewArguments& arguments)
      : viewed_(viewed),
        aspect_(arguments.aspect()),
        window_(arguments.request.path.string(), arguments.width_px, arguments.height_px) {
    window_.on_key([this](const std::string& key) { take_key(key); });
    window_.look_from(viewed_.viewpoint(arguments.from, aspect_));
    show();
  }

  /// Returns when the window is closed or the user interrupts.
  void run() {
    constexpr std::chrono::milliseconds a_screen_refresh(16);
    while (!is_interrupted() && window_.handle_events()) {
      std::this_thread::sleep_for(a_screen_refresh);
    }
  }

 private:
  void show() {
    window_.show(viewed_.drawing());
    window_.set_legend(viewed_.legend());
    tell();
  }

  void tell() {
    std::string help = "h: help";
    if (has_help_) {
      const std::string own = viewed_.help();
      help =
          "left button: rotate, middle: pan, wheel: zoom; 1, 2, 3: from outside, above, inside\n" +
          (own.empty() ? "" : own + "\n") + "c: colour, h: hide help, q: close";
    }
    window_.set_text(viewed_.status(), help);
  }

  void take_key(const std::string& key) {
    if (key == "h") {
      has_help_ = !has_help_;
      tell();
    } else if (key == "c") {
      viewed_.color_by_next();
      show();
    } else if (key == "1" || key == "2" || key == "3") {
      const char* from = key == "1" ? "outside" : key == "2" ? "above" : "inside";
      window_.look_from(viewed_.viewpoint(from, aspect_));
    } else if (viewed_.take_key(key)) {
      show();
    }
  }

  Viewed& viewed_;
  double aspect_;
  Window window_;
  bool has_help_ = true;
};

void open_window(Viewed& viewed, const ViewArguments& arguments) {
  try {
    ViewWindow(viewed, arguments).run();
  } catch (const DrawingError& error) {
    throw UsageError(std::string(error.what()) + "; --screenshot FILE.png works without a display");
  }
}

/// Writes a PNG picture of the requested size, with the legend in its corner.
void write_screenshot(const Viewed& viewed, const ViewArguments& arguments) {
  Drawing drawing = viewed.drawing();
  if (arguments.from == "inside")
    drawing.lines.clear();  // the path would pass through the viewpoint
  Picture picture = draw(drawing, viewed.viewpoint(arguments.from, arguments.aspect()),
                         arguments.width_px, arguments.height_px);
  constexpr int margin_px = 10;
  const Picture legend = viewed.legend();
  paste(picture, legend, picture.width_px - legend.width_px - margin_px, margin_px);
  write_picture(arguments.screenshot, picture);
}

int run_view(const ViewArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("view", options);
  const ViewRequest& request = arguments.request;
  if (!request.method.empty()) table.set("unwrap.method", request.method);
  if (!arguments.screenshot.empty() && arguments.screenshot.extension() != ".png") {
    throw UsageError(arguments.screenshot.string() +
                     ": pictures are written as PNG; the name must end in .png");
  }
  const std::unique_ptr<Viewed> viewed = open_viewed(request, options);
  if (!request.color.empty()) viewed->color_by(request.color);
  if (arguments.screenshot.empty()) {
    open_window(*viewed, arguments);
    return is_interrupted() ? exit_status::interrupted : exit_status::done;
  }
  write_screenshot(*viewed, arguments);
  if (!arguments.common.quiet) std::printf("picture: %s\n", arguments.screenshot.c_str());
  return exit_status::done;
}

/// All names of colourings, without repetition.
std::set<std::string> all_color_names() {
  std::set<std::string> names;
  for (const auto& of : {color_names::map, color_names::frame, color_names::mesh}) {
    names.insert(of.begin(), of.end());
  }
  return names;
}

}  // namespace

void add_view_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<ViewArguments>();
  ViewRequest& request = arguments->request;
  CLI::App* app = program.add_subcommand(
      "view", "show a map, cloud, mesh or recording, or the maps of an evaluation");
  app->add_option("PATH", request.path,
                  "result folder of map, merge, register or evaluate, a map.db, PLY, PCD, VTK or "
                  "OBJ file, or "
                  "a recording")
      ->required();
  app->add_option("--screenshot", arguments->screenshot,
                  "write a PNG picture instead of opening a window; needs no display");
  app->add_option("--from", arguments->from, "viewpoint: outside, above, inside")
      ->check(CLI::IsMember({"outside", "above", "inside"}));
  app->add_option("--color", request.color,
                  "colouring of a map (" + joined(color_names::map, ", ") + "), of a frame (" +
                      joined(color_names::frame, ", ") + ") or of a mesh (" +
                      joined(color_names::mesh, ", ") + ")")
      ->type_name("{" + joined(all_color_names(), ",") + "}");
  app->add_flag("--cameras", request.cameras,
                "show the field of view of the camera at the keyframes");
  app->add_option("--keyframe", request.keyframe,
                  "id of the keyframe of a map to show, counted from 0; keys n and b step on")
      ->check(CLI::Range(0, 1000000));
  app->add_flag("--wrapped", request.wrapped,
                "show the ranges of a frame as measured, without unwrapping");
  add_method_option(*app, request.method,
                    "how to unwrap a recording (default: unwrap.method), or which map of an "
                    "evaluation to show first");
  app->add_option("--frame", request.frame, "index of the frame of a recording, counted from 0")
      ->check(CLI::Range(0, 1000000));
  app->add_option("--width", arguments->width_px, "width of the picture or window, pixels")
      ->check(CLI::Range(16, 8000));
  app->add_option("--height", arguments->height_px, "height of the picture or window, pixels")
      ->check(CLI::Range(16, 8000));
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_view(*arguments); });
}

}  // namespace tofmap::app

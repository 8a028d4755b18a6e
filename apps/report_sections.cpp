// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "report_sections.hpp"

#include "frame_report.hpp"
#include "output_file.hpp"
#include "sampled_frames.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/visualization/drawing.hpp>
#include <tofmap/visualization/frame_strip.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

constexpr int map_width_px = 900;

/// Of a map whose truth is known: from here on points are all drawn as wrong.
constexpr double wrong_m = 0.2;

// The palette of Okabe and Ito, as in plots; the truth is black and lies undermost.
constexpr std::array<Rgb, 4> path_colors{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}}};

bool have_errors(const std::vector<ShownMap>& maps) {
  return std::ranges::all_of(
      maps, [](const ShownMap& map) { return map.errors_m.size() == map.surface->size(); });
}

MapColoring color_by_error(const ShownMap& map) {
  return {map.errors_m, ColorScale(0, wrong_m, "error, m", ColorRamp::error)};
}

/// The level frame of the first map. Its box holds the others, too, as far as they are not more
/// than half as large again: a map that went to pieces does not make the first one small.
LevelFrame frame_of(const std::vector<ShownMap>& maps) {
  LevelFrame frame = level_frame(*maps.front().surface, *maps.front().trajectory);
  if (frame.box_m.isEmpty()) return frame;
  const Eigen::Vector3d margin_m(frame.box_m.sizes().x() / 4, frame.box_m.sizes().y() / 4, 0);
  const Eigen::AlignedBox3d limit_m(frame.box_m.min() - margin_m, frame.box_m.max() + margin_m);
  for (const ShownMap& map : maps) {
    const Eigen::AlignedBox3d box_m = level_box(*map.surface, frame.level_from_map);
    if (!box_m.isEmpty()) frame.box_m.extend(box_m.intersection(limit_m));
  }
  return frame;
}

std::vector<PageFigure> maps_from_above(const std::vector<ShownMap>& maps, const LevelFrame& frame,
                                        bool by_error) {
  std::vector<PageFigure> figures;
  for (const ShownMap& map : maps) {
    const MapColoring coloring =
        by_error ? color_by_error(map) : color_by_height(*map.surface, frame);
    figures.push_back({map_from_above(*map.surface, *map.trajectory, frame, coloring, map_width_px),
                       map.name + (by_error ? ", coloured by distance to the true surface"
                                            : ", coloured by height")});
  }
  return figures;
}

Trajectory moved(const Pose& target_from_source, const Trajectory& trajectory) {
  Trajectory out = trajectory;
  for (StampedPose& pose : out)
    pose.world_from_camera = target_from_source * pose.world_from_camera;
  return out;
}

/// All paths in the frame of the first map; if the truth is known, each as it fits it best.
std::vector<NamedPath> paths_of(const std::vector<ShownMap>& maps, const Trajectory& truth) {
  std::vector<NamedPath> paths;
  const std::optional<Pose>& truth_from_first = maps.front().truth_from_map;
  if (!truth.empty() && truth_from_first) {
    paths.push_back({"truth", moved(truth_from_first->inverse(), truth), colors::black, 6});
  }
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const ShownMap& map = maps[i];
    if (i > 0 && map.trajectory == maps.front().trajectory) continue;  // the same path
    const Pose first_from_map = truth_from_first && map.truth_from_map
                                    ? truth_from_first->inverse() * *map.truth_from_map
                                    : Pose::Identity();
    paths.push_back({map.name, moved(first_from_map, *map.trajectory),
                     path_colors.at(i % path_colors.size()), 2.5F});
  }
  return paths;
}

/// A cloud of the scene, of every so many points of a map.
SceneCloud scene_cloud(const ShownMap& map, const LevelFrame& frame, bool by_error, int most) {
  std::vector<MapColoring> colorings;
  if (by_error) colorings.push_back(color_by_error(map));
  colorings.push_back(color_by_height(*map.surface, frame));
  const Eigen::Matrix3f level_from_map = frame.level_from_map.cast<float>();
  const std::size_t step =
      std::max<std::size_t>(1, (map.surface->size() + most - 1) / static_cast<std::size_t>(most));
  SceneCloud cloud;
  cloud.name = map.name;
  cloud.colorings.resize(colorings.size());
  for (std::size_t i = 0; i < map.surface->size(); i += step) {
    const MapPoint& point = (*map.surface)[i];
    const Eigen::Vector3f place = level_from_map * point.getVector3fMap();
    if (!place.allFinite()) continue;
    const Eigen::Vector3f normal = level_from_map * point.getNormalVector3fMap();
    cloud.points_m.push_back(place);
    cloud.normals.push_back(normal.allFinite() ? normal : Eigen::Vector3f::Zero());
    for (std::size_t k = 0; k < colorings.size(); ++k) {
      cloud.colorings[k].push_back(colorings[k].scale(colorings[k].values[i]));
    }
  }
  return cloud;
}

/// How wide a point is drawn: somewhat wider than points of a room's surface are apart.
float point_size_m(const LevelFrame& frame, std::size_t points) {
  if (frame.box_m.isEmpty()) return 0.05F;
  const Eigen::Vector3d size = frame.box_m.sizes();
  const double surface_m2 = 2 * (size.x() * size.y() + size.y() * size.z() + size.x() * size.z());
  return static_cast<float>(
      std::clamp(1.3 * std::sqrt(surface_m2 / std::max<double>(1, points)), 0.02, 0.3));
}

PageScene scene_of(const std::vector<ShownMap>& maps, const LevelFrame& frame, bool by_error,
                   const std::vector<NamedPath>& paths, int most_points) {
  constexpr int legend_height_px = 220;
  PageScene scene;
  for (const ShownMap& map : maps) {
    scene.clouds.push_back(scene_cloud(map, frame, by_error, most_points));
  }
  if (by_error) {
    scene.colorings.push_back(
        {"error", color_bar(color_by_error(maps.front()).scale, legend_height_px)});
  }
  scene.colorings.push_back(
      {"height", color_bar(color_by_height({}, frame).scale, legend_height_px)});
  for (const NamedPath& path : paths) {
    ScenePath line{path.name, {}, path.color};
    for (const StampedPose& pose : path.trajectory) {
      line.points_m.push_back(
          (frame.level_from_map * pose.world_from_camera.translation()).cast<float>());
    }
    scene.paths.push_back(std::move(line));
  }
  scene.point_size_m = point_size_m(frame, scene.clouds.front().points_m.size());
  return scene;
}

StagedFrame staged_frame(const DualFrequencyFrame& frame, const SensorModel& sensor,
                         const PixelRays& rays, const PipelineOptions& pipeline,
                         Unwrapper& unwrapper) {
  const PreparedFrame prepared = prepare_frame(frame, unwrapper, sensor, rays, pipeline);
  StagedFrame staged;
  staged.title = formatted("Frame %d, %.2f s", frame.index, frame.timestamp_s);
  staged.amplitude = frame.amplitude_a;
  staged.wrapped_m = frame.phase_a * static_cast<float>(sensor.modulation.wavelength_a_m());
  staged.unwrapped = prepared.unwrapped.image;
  staged.filtered = prepared.filtered.image;
  return staged;
}

}  // namespace

std::vector<OptionField<ReportOptions>> ReportOptions::fields() {
  using O = ReportOptions;
  return {
      {"frames", &O::frames, 0, 200, "",
       "frames that report.html steps through, spread evenly over the recording"},
      {"points", &O::points, 1000, 500000, "",
       "points, at most, of a map that can be turned in report.html"},
  };
}

Verdict verdict_on(const MapScore& score, double voxel_m) {
  constexpr double much = 5;
  if (!(score.accuracy_m <= much * voxel_m)) return Verdict::bad;  // also of an empty map
  return score.accuracy_m <= voxel_m ? Verdict::good : Verdict::doubtful;
}

void add_drawn(ReportPage& page, const std::function<std::vector<PageFigure>()>& draw) {
  try {
    page.add_figures(draw());
  } catch (const DrawingError& error) {
    page.add_text(std::string("Not drawn: ") + error.what());
  }
}

void add_maps(ReportPage& page, const std::vector<ShownMap>& maps, const Trajectory& truth,
              const ReportOptions& options) {
  const ShownMap& first = maps.front();
  const LevelFrame frame = frame_of(maps);
  const bool by_error = have_errors(maps);
  const std::vector<NamedPath> paths = paths_of(maps, truth);
  page.add_heading("The map from above");
  add_drawn(page, [&] { return maps_from_above(maps, frame, by_error); });
  if (by_error) add_drawn(page, [&] { return maps_from_above(maps, frame, false); });
  page.add_heading("The way of the camera");
  add_drawn(page, [&] {
    return std::vector<PageFigure>{{paths_from_above(*first.surface, paths, frame, map_width_px),
                                    "paths from above, over the map " + first.name}};
  });
  page.add_heading("The map, to be turned");
  page.add_text(
      "Drag to turn, scroll to come nearer, drag with the right button to shift. Surfaces are seen "
      "from the side that the camera saw.");
  page.add_scene(scene_of(maps, frame, by_error, paths, options.points));
}

void add_frames(ReportPage& page, const std::vector<DualFrequencyFrame>& frames,
                const SensorModel& sensor, const PipelineOptions& pipeline,
                const std::function<std::optional<ImageF>(int index)>& truth_m,
                const ReportOptions& options) {
  if (frames.empty() || options.frames == 0) return;
  const PixelRays rays = pixel_rays(sensor.camera);
  Unwrapper unwrapper(sensor, pipeline.unwrap);
  std::vector<StagedFrame> staged;
  for (const int i : spread_indices(static_cast<int>(frames.size()), options.frames)) {
    const DualFrequencyFrame& frame = frames[static_cast<std::size_t>(i)];
    staged.push_back(staged_frame(frame, sensor, rays, pipeline, unwrapper));
    if (auto truth = truth_m(frame.index)) staged.back().truth_m = *std::move(truth);
  }
  const FrameStrip strip = frame_strip(staged, sensor.modulation.wavelength_a_m());
  page.add_heading("Frames, from what was measured to what goes into the map");
  page.add_text("Step by the buttons, the slider, or the arrow keys.");
  page.add_strip(strip.frames, strip.legends);
}

void add_consistency(ReportPage& page, const std::vector<std::string>& names,
                     const std::vector<Consistency>& runs) {
  PageTable table;
  table.header = {"without any truth"};
  table.header.insert(table.header.end(), names.begin(), names.end());
  const auto add_row = [&](const char* measure, const char* format, double Consistency::*value) {
    std::vector<std::string> row{measure};
    for (const Consistency& run : runs) {
      row.push_back(std::isfinite(run.*value) ? formatted(format, run.*value) : "-");
    }
    table.rows.push_back(std::move(row));
  };
  add_row("points that other frames see through, %", "%.2f", &Consistency::contradicted_percent);
  add_row("pixels that fit the beat better with another count, %", "%.2f",
          &Consistency::beat_misfit_percent);
  add_row("difference of B from what A says, cycles (RMS)", "%.4f",
          &Consistency::beat_residual_cycles);
  add_row("pixels whose count the frequencies cannot tell, %", "%.2f",
          &Consistency::ambiguous_percent);
  add_row("thickness of planes in the map, m (median)", "%.4f", &Consistency::plane_thickness_m);
  add_row("curls that did not vanish, a frame (jump, single)", "%.1f",
          &Consistency::curl_violations_per_frame);
  page.add_heading("Does it agree with itself?");
  page.add_table(table);
}

void add_stage_times(ReportPage& page, const std::vector<std::string>& names,
                     const std::vector<const RoomMap*>& runs) {
  PageTable table;
  table.header = {"stage, ms per frame"};
  table.header.insert(table.header.end(), names.begin(), names.end());
  std::vector<StageTimes> means;
  for (const RoomMap* run : runs) means.push_back(mean_times(*run));
  const auto add_row = [&](const char* stage, const auto& time_of) {
    std::vector<std::string> row{stage};
    for (const StageTimes& mean : means) row.push_back(formatted("%.1f", time_of(mean)));
    table.rows.push_back(std::move(row));
  };
  add_row("unwrap", [](const StageTimes& times) { return times.unwrap_ms; });
  add_row("filter", [](const StageTimes& times) { return times.filter_ms; });
  add_row("cloud", [](const StageTimes& times) { return times.cloud_ms; });
  add_row("register", [](const StageTimes& times) { return times.register_ms; });
  add_row("map", [](const StageTimes& times) { return times.map_ms; });
  add_row("loops", [](const StageTimes& times) { return times.loop_ms; });
  add_row("all", [](const StageTimes& times) { return times.total_ms(); });
  page.add_heading("Time");
  page.add_table(table);
}

void add_options(ReportPage& page, const std::string& options_yaml) {
  page.add_heading("How it was made");
  page.add_folded("Options, to be used again with --config", options_yaml);
}

void write_page(const std::filesystem::path& result, const ReportPage& page) {
  OutputFile file(result / "report.html", [](const auto&) { return true; });
  std::ofstream out(file.path(), std::ios::binary);
  out << page.html();
  out.close();
  if (!out) {
    throw InputError((result / "report.html").string() +
                     ": cannot be written; is the disk full, the folder writable?");
  }
  file.commit();
}

}  // namespace tofmap::app

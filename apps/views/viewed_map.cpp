// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "views/map_details.hpp"
#include "views/viewed.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <optional>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/mapping/map_store.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

namespace fs = std::filesystem;

/// Reads a trajectory. Lines that cannot be read are left out and named on stderr. Empty if there
/// is no such file.
Trajectory read_if_there(const fs::path& file) {
  std::error_code unknown;
  if (!fs::is_regular_file(file, unknown)) return {};
  UsableTrajectory usable = read_usable_trajectory(file);
  if (!usable.damages.empty()) {
    std::fprintf(stderr, "tofmap: %s left out; the first: %s\n",
                 counted(usable.damages.size(), "pose").c_str(), usable.damages.front().c_str());
  }
  return std::move(usable.poses);
}

/// The 98th percentile of the number of observations of a point.
float most_observations(const MapCloud& map) {
  std::vector<std::uint32_t> counts;
  for (const MapPoint& point : map) counts.push_back(point.observations);
  const auto place = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() * 98 / 100);
  std::nth_element(counts.begin(), place, counts.end());
  return static_cast<float>(std::max<std::uint32_t>(1, *place));
}

/// The details of a map file. Empty if it is not there, or cannot be read, which is told on stderr.
std::optional<MapDetails> details_if_there(const fs::path& file) {
  std::error_code unknown;
  if (!fs::is_regular_file(file, unknown)) return std::nullopt;
  try {
    return MapDetails(MapStore::open(file).content());
  } catch (const InputError& error) {
    std::fprintf(stderr, "tofmap: without keyframes: %s\n", error.what());
    return std::nullopt;
  }
}

/// A map with its trajectory and keyframes.
struct PathedMap {
  explicit PathedMap(const ViewedFile& from) : method(from.method) {
    if (from.file.extension() == ".db") {
      details.emplace(MapStore::open(from.file).content());
      map = surface_of(details->content(), details->map());
      keyframes = all_keyframes_of(details->content(), details->map());
      trajectory = keyframes;
      return;
    }
    map = read_map(from.file);
    trajectory = read_if_there(from.file.parent_path() / "trajectory.txt");
    keyframes = read_if_there(from.file.parent_path() / "keyframes.txt");
    if (from.file.filename() == "map.ply") {
      details = details_if_there(from.file.parent_path() / map_file_name);
    }
  }

  std::string method;
  MapCloud map;
  Trajectory trajectory;
  Trajectory keyframes;
  std::optional<MapDetails> details;  ///< empty without a map file
};

class ViewedMaps final : public Viewed {
 public:
  ViewedMaps(const std::vector<ViewedFile>& files, const ViewRequest& request)
      : Viewed(color_names::map), with_cameras_(request.cameras) {
    for (const ViewedFile& file : files) add(file);
    if (request.keyframe) show_keyframe(*request.keyframe);
    frame_ = gravity_aligned_frame(shown().map, shown().trajectory);
  }

  Drawing drawing() const override {
    Drawing drawing = map_drawing(shown().map, shown().trajectory, frame_, coloring());
    if (color() == "plain") {
      for (PointLayer& layer : drawing.points) std::ranges::fill(layer.colors, plain);
    }
    if (!with_path_) drawing.lines.clear();
    if (with_cameras_) add_cameras(drawing);
    if (shown().details) {
      if (with_changes_) shown().details->add_changes(drawing, Pose(frame_.aligned_from_map));
      shown().details->add_keyframe(drawing, Pose(frame_.aligned_from_map));
    }
    return drawing;
  }

  Viewpoint viewpoint(const std::string& from, double aspect) const override {
    if (from == "above") return viewpoint_above(frame_.box_m, aspect);
    if (from != "inside") return viewpoint_outside(frame_.box_m);
    return viewpoint_inside(map_drawing(shown().map, shown().trajectory, frame_),
                            shown().trajectory, frame_, aspect);
  }

  Picture legend() const override {
    constexpr int height_px = 220;
    return color() == "plain" ? Picture() : color_bar(coloring().scale, height_px);
  }

  std::string status() const override {
    std::string text = shown().method.empty() ? "" : "method " + shown().method + ": ";
    text += counted(shown().map.size(), "point") + ", coloured by " + color();
    if (!shown().trajectory.empty()) text += "; " + counted(shown().trajectory.size(), "pose");
    if (!shown().keyframes.empty()) text += ", " + counted(shown().keyframes.size(), "keyframe");
    if (shown().details) {
      const std::string of_keyframe = shown().details->status();
      if (!of_keyframe.empty()) text += "\n" + of_keyframe;
    }
    return text + without_points_;
  }

  std::string help() const override {
    std::vector<std::string> keys;
    if (maps_.size() > 1) keys.emplace_back("m: map of the next method");
    if (!shown().trajectory.empty()) {
      keys.emplace_back("p: path of the camera, f: its field of view at keyframes");
    }
    if (shown().details) {
      keys.emplace_back("n, b: next keyframe and the one before");
      if (shown().details->has_changes()) keys.emplace_back("g: what has changed");
    }
    return joined(keys, ", ");
  }

  bool take_key(const std::string& key) override {
    if (key == "m" && maps_.size() > 1) {
      shown_ = (shown_ + 1) % maps_.size();
      return true;
    }
    if (shown().details && (key == "n" || key == "b")) {
      maps_[shown_].details->step(key == "n" ? 1 : -1);
      return true;
    }
    if (shown().details && key == "g") {
      with_changes_ = !with_changes_;
      return true;
    }
    if (shown().trajectory.empty() || (key != "p" && key != "f")) return false;
    bool& is_drawn = key == "p" ? with_path_ : with_cameras_;
    is_drawn = !is_drawn;
    return true;
  }

 private:
  static constexpr Rgb plain{190, 196, 204};

  const PathedMap& shown() const { return maps_[shown_]; }

  /// Reads a map. Throws InputError if it is the first and cannot be read or has no points; others
  /// of which that is true are left out, and named on stderr or in the status.
  void add(const ViewedFile& file) {
    try {
      PathedMap read(file);
      if (!read.map.empty()) {
        most_observations_ = std::max(most_observations_, most_observations(read.map));
        maps_.push_back(std::move(read));
      } else if (maps_.empty()) {
        throw InputError(file.file.string() + ": has no points; nothing to view");
      } else {
        without_points_ += (without_points_.empty() ? "; without points: " : ", ") + file.method;
      }
    } catch (const InputError& error) {
      if (maps_.empty()) throw;
      std::fprintf(stderr, "tofmap: left out: %s\n", error.what());
    }
  }

  void show_keyframe(int id) {
    if (!shown().details) {
      throw UsageError("--keyframe needs a map file, map.db, which 'tofmap map' writes");
    }
    maps_[shown_].details->show(id);
  }

  MapColoring coloring() const {
    if (color() == "confidence") return colored_by(&MapPoint::confidence, {0, 1, "confidence"});
    if (color() == "count") {
      return colored_by(&MapPoint::observations, {0, most_observations_, "observations"});
    }
    return color_by_height(shown().map, frame_);
  }

  template <class Value>
  MapColoring colored_by(Value MapPoint::*value, ColorScale scale) const {
    MapColoring coloring{{}, std::move(scale)};
    for (const MapPoint& point : shown().map) {
      coloring.values.push_back(static_cast<float>(point.*value));
    }
    return coloring;
  }

  /// Adds the field of view of the camera at the keyframes or, if these are unknown, at some of the
  /// poses.
  void add_cameras(Drawing& drawing) const {
    constexpr std::size_t most = 100;
    const Trajectory& poses = shown().keyframes.empty() ? shown().trajectory : shown().keyframes;
    const std::size_t step = std::max<std::size_t>(1, poses.size() / most);
    for (std::size_t i = 0; i < poses.size(); i += step) {
      drawing.lines.push_back(
          camera_outline(Pose(frame_.aligned_from_map) * poses[i].world_from_camera));
      drawing.lines.back().width_px = 1;  // there are many
    }
  }

  std::vector<PathedMap> maps_;
  std::size_t shown_ = 0;
  std::string without_points_;   ///< for the status
  float most_observations_ = 0;  ///< upper end of the colour scale of observations, for all maps
  GravityAlignedFrame frame_;    ///< of the first map, used for all
  bool with_path_ = true;
  bool with_changes_ = true;
  bool with_cameras_;
};

}  // namespace

std::unique_ptr<Viewed> view_maps(const std::vector<ViewedFile>& files,
                                  const ViewRequest& request) {
  return std::make_unique<ViewedMaps>(files, request);
}

}  // namespace tofmap::app

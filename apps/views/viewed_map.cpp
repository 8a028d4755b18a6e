// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "views/viewed.hpp"

#include <algorithm>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

namespace fs = std::filesystem;

Trajectory read_if_there(const fs::path& file) {
  return fs::exists(file) ? read_trajectory(file) : Trajectory{};
}

/// The number of observations that all but a few points stay below.
float most_observations(const MapCloud& map) {
  std::vector<std::uint32_t> counts;
  for (const MapPoint& point : map) counts.push_back(point.observations);
  const auto place = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() * 98 / 100);
  std::nth_element(counts.begin(), place, counts.end());
  return static_cast<float>(std::max<std::uint32_t>(1, *place));
}

class ViewedMap final : public Viewed {
 public:
  ViewedMap(const fs::path& map_file, const fs::path& folder, bool with_cameras)
      : Viewed({"height", "confidence", "count", "plain"}),
        map_(read_map(map_file)),
        trajectory_(read_if_there(folder / "trajectory.txt")),
        keyframes_(read_if_there(folder / "keyframes.txt")),
        with_cameras_(with_cameras) {
    if (map_.empty()) throw InputError(map_file.string() + ": holds no point; nothing to view");
    frame_ = level_frame(map_, trajectory_);
  }

  Drawing drawing() const override {
    Drawing drawing = map_drawing(map_, trajectory_, frame_, coloring());
    if (color() == "plain") {
      for (PointLayer& layer : drawing.points) std::ranges::fill(layer.colors, plain);
    }
    if (!with_path_) drawing.lines.clear();
    if (with_cameras_) add_cameras(drawing);
    return drawing;
  }

  Viewpoint viewpoint(const std::string& from, double aspect) const override {
    if (from == "above") return viewpoint_above(frame_.box_m, aspect);
    if (from != "inside") return viewpoint_outside(frame_.box_m);
    return viewpoint_inside(map_drawing(map_, trajectory_, frame_), trajectory_, frame_, aspect);
  }

  Picture legend() const override {
    constexpr int height_px = 220;
    return color() == "plain" ? Picture() : color_bar(coloring().scale, height_px);
  }

  std::string status() const override {
    std::string text = counted(map_.size(), "point") + ", coloured by " + color();
    if (!trajectory_.empty()) text += "; " + counted(trajectory_.size(), "pose");
    if (!keyframes_.empty()) text += ", " + counted(keyframes_.size(), "keyframe");
    return text;
  }

  std::string help() const override {
    return trajectory_.empty() ? "" : "p: path of the camera, f: what it saw from keyframes";
  }

  bool take_key(const std::string& key) override {
    if (trajectory_.empty() || (key != "p" && key != "f")) return false;
    bool& shown = key == "p" ? with_path_ : with_cameras_;
    shown = !shown;
    return true;
  }

 private:
  static constexpr Rgb plain{190, 196, 204};

  MapColoring coloring() const {
    if (color() == "confidence") return colored_by(&MapPoint::confidence, {0, 1, "confidence"});
    if (color() == "count") {
      return colored_by(&MapPoint::observations, {0, most_observations(map_), "observations"});
    }
    return color_by_height(map_, frame_);
  }

  template <class Value>
  MapColoring colored_by(Value MapPoint::*value, ColorScale scale) const {
    MapColoring coloring{{}, std::move(scale)};
    for (const MapPoint& point : map_) {
      coloring.values.push_back(static_cast<float>(point.*value));
    }
    return coloring;
  }

  /// Those of the keyframes; if they are not known, of some poses.
  void add_cameras(Drawing& drawing) const {
    constexpr std::size_t most = 100;
    const Trajectory& poses = keyframes_.empty() ? trajectory_ : keyframes_;
    const std::size_t step = std::max<std::size_t>(1, poses.size() / most);
    for (std::size_t i = 0; i < poses.size(); i += step) {
      drawing.lines.push_back(
          camera_outline(Pose(frame_.level_from_map) * poses[i].world_from_camera));
      drawing.lines.back().width_px = 1;  // there are many
    }
  }

  MapCloud map_;
  Trajectory trajectory_;
  Trajectory keyframes_;
  LevelFrame frame_;
  bool with_path_ = true;
  bool with_cameras_;
};

}  // namespace

std::unique_ptr<Viewed> view_map(const fs::path& map_file, const fs::path& folder,
                                 bool with_cameras) {
  return std::make_unique<ViewedMap>(map_file, folder, with_cameras);
}

}  // namespace tofmap::app

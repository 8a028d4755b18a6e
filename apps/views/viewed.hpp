// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options/options.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <tofmap/visualization/drawing.hpp>

namespace tofmap::app {

/// The command line arguments of `view` that say what to show.
struct ViewRequest {
  std::filesystem::path path;
  /// One of color_names. Empty: the first of them.
  std::string color;
  /// Maps only: draws the field of view of the camera at the keyframes, as pyramids.
  bool cameras = false;
  /// Maps with a map file only: id of the keyframe that is shown first; empty: none.
  std::optional<int> keyframe;
  /// Recordings only: shows ranges as measured, without unwrapping.
  bool wrapped = false;
  /// Recordings: the unwrapping method; empty: that of the options. Evaluations: the method whose
  /// map is shown first; empty: the most accurate.
  std::string method;
  /// Recordings only: index of the frame; empty: the first.
  std::optional<int> frame;
};

/// The colourings of each kind of Viewed. The first of each is the default.
namespace color_names {
inline const std::vector<std::string> map{"height", "confidence", "count", "plain"};
inline const std::vector<std::string> frame{"moved",      "range",  "wrap",
                                            "confidence", "height", "amplitude"};
inline const std::vector<std::string> mesh{"reflectance"};
}  // namespace color_names

/// Something that `view` can show, in several colourings.
class Viewed {
 public:
  Viewed() = default;
  Viewed(const Viewed&) = delete;
  Viewed& operator=(const Viewed&) = delete;
  virtual ~Viewed() = default;

  /// Points, lines and meshes to be drawn, in the current colouring.
  virtual Drawing drawing() const = 0;

  /// The viewpoint called `from` ("outside", "above" or "inside"), for a picture whose width is
  /// `aspect` times its height.
  virtual Viewpoint viewpoint(const std::string& from, double aspect) const = 0;

  /// The legend of the current colouring. Empty if it has none.
  virtual Picture legend() const = 0;

  /// One or two lines of text about what is shown.
  virtual std::string status() const = 0;

  /// One line of help about the keys of take_key. Empty if there are none.
  virtual std::string help() const { return {}; }

  /// Reacts to a key. Returns whether the drawing changed. Throws InputError if a file cannot be
  /// read.
  virtual bool take_key(const std::string& /*key*/) { return false; }

  /// The names of the colourings.
  const std::vector<std::string>& color_names() const { return color_names_; }

  /// Chooses a colouring. Throws UsageError if there is none of this name.
  void color_by(const std::string& name);

  /// Chooses the next colouring, and the first after the last.
  void color_by_next();

 protected:
  explicit Viewed(std::vector<std::string> color_names) : color_names_(std::move(color_names)) {}

  const std::string& color() const { return color_names_[color_]; }

 private:
  std::vector<std::string> color_names_;
  std::size_t color_ = 0;
};

/// Opens a map, cloud, mesh or recording, or the result folder of map, register or evaluate. Throws
/// InputError if there is nothing to show, UsageError if the request has arguments that do not
/// apply.
std::unique_ptr<Viewed> open_viewed(const ViewRequest& request, const ProgramOptions& options);

/// A map or cloud file, or a map file (.db). trajectory.txt, keyframes.txt and map.db beside
/// map.ply are read as well if they exist.
struct ViewedFile {
  std::filesystem::path file;
  std::string method;  ///< that made the map; empty if there is only one map
};

/// Shows one of several maps at a time, all in the gravity-aligned frame of the first. Throws
/// InputError if the first cannot be read or has no points; others of which that is true are left
/// out.
std::unique_ptr<Viewed> view_maps(const std::vector<ViewedFile>& files, const ViewRequest& request);

/// Shows one frame of a recording at a time, unwrapped and filtered with the options.
std::unique_ptr<Viewed> view_recording(const ViewRequest& request, const ProgramOptions& options);

/// A view of a box from straight above, in parallel projection, for a picture whose width is
/// `aspect` times its height.
Viewpoint viewpoint_above(const Eigen::AlignedBox3d& box_m, double aspect);

}  // namespace tofmap::app

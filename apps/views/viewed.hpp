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

/// What `view` is asked to show, and how.
struct ViewRequest {
  std::filesystem::path path;
  std::string color;         ///< empty: the first there is
  bool cameras = false;      ///< of a map: pyramids of what the camera saw
  bool wrapped = false;      ///< of a recording: ranges as measured
  std::string method;        ///< of a recording: how it is unwrapped; empty: as the options say.
                             ///< Of an evaluation: whose map is the first; empty: the best that
                             ///< there is
  std::optional<int> frame;  ///< of a recording; none: the first
};

/// What can be coloured by what; the first is the one that is taken if nothing is asked for.
namespace color_names {
inline const std::vector<std::string> map{"height", "confidence", "count", "plain"};
inline const std::vector<std::string> frame{"moved",      "range",  "wrap",
                                            "confidence", "height", "amplitude"};
inline const std::vector<std::string> mesh{"reflectance"};
}  // namespace color_names

/// Something that can be looked at in several ways.
class Viewed {
 public:
  Viewed() = default;
  Viewed(const Viewed&) = delete;
  Viewed& operator=(const Viewed&) = delete;
  virtual ~Viewed() = default;

  virtual Drawing drawing() const = 0;

  /// `from` is outside, above or inside.
  virtual Viewpoint viewpoint(const std::string& from, double aspect) const = 0;

  /// What the colours mean; empty if there is nothing to say.
  virtual Picture legend() const = 0;

  /// What is seen, in a line or two.
  virtual std::string status() const = 0;

  /// The keys that it has beyond those of all views, a line; empty if there is none.
  virtual std::string help() const { return {}; }

  /// Whether the key changed what is seen. Throws InputError as reading files does.
  virtual bool take_key(const std::string& /*key*/) { return false; }

  /// What it can be coloured by.
  const std::vector<std::string>& color_names() const { return color_names_; }

  /// Throws UsageError if there is no such colour.
  void color_by(const std::string& name);
  void color_by_next();

 protected:
  explicit Viewed(std::vector<std::string> color_names) : color_names_(std::move(color_names)) {}

  const std::string& color() const { return color_names_[color_]; }

 private:
  std::vector<std::string> color_names_;
  std::size_t color_ = 0;
};

/// A map, cloud, mesh, recording, or the result of map, register or evaluate. Throws InputError if
/// there is nothing to see, UsageError if what is there cannot be shown as requested.
std::unique_ptr<Viewed> open_viewed(const ViewRequest& request, const ProgramOptions& options);

/// A map or cloud to be read; path and keyframes beside it may not be there.
struct MapFile {
  std::filesystem::path file;
  std::string method;  ///< that made it, where there are maps of several
};

/// One map at a time, in the place of the first and by one scale; others without a point are left
/// out. Throws InputError if the first has none.
std::unique_ptr<Viewed> view_maps(const std::vector<MapFile>& files, bool with_cameras);

/// A frame of a recording at a time, unwrapped and filtered as the options say.
std::unique_ptr<Viewed> view_recording(const ViewRequest& request, const ProgramOptions& options);

/// From straight above, in parallel projection.
Viewpoint viewpoint_above(const Eigen::AlignedBox3d& box_m, double aspect);

}  // namespace tofmap::app

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <tofmap/core/verdict.hpp>
#include <tofmap/visualization/picture.hpp>

namespace tofmap {

struct PageFigure {
  Picture picture;
  std::string caption;  ///< also told to those who do not see the picture
};

/// Cells as text. Rows are as long as the header.
struct PageTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// A frame in several pictures, and what there is to say of it.
struct StripFrame {
  std::string title;
  std::vector<PageFigure> panels;
  std::string remark;
};

/// Points to be turned, with a normal each (zero: none) and a colour each for every colouring.
struct SceneCloud {
  std::string name;
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Eigen::Vector3f> normals;  ///< of unit length, or zero: not known
  std::vector<std::vector<Rgb>> colorings;
};

struct ScenePath {
  std::string name;
  std::vector<Eigen::Vector3f> points_m;
  Rgb color;
};

struct SceneColoring {
  std::string name;
  Picture legend;
};

/// Clouds and paths in one frame, z up. One cloud is shown at a time.
struct PageScene {
  std::vector<SceneCloud> clouds;
  std::vector<ScenePath> paths;
  std::vector<SceneColoring> colorings;
  float point_size_m = 0.05F;
};

/// A report as one HTML file that needs nothing else: pictures, styles, scripts and points are
/// within. Texts are plain; the page escapes them. Without scripts all of it can be read but the
/// scene, and in print too. Parts come in the order in which they are added.
class ReportPage {
 public:
  ReportPage(std::string title, const std::string& subtitle);

  void add_verdict(Verdict verdict, const std::string& sentence);
  void add_warnings(const std::vector<std::string>& warnings);  ///< nothing if there is none
  void add_heading(const std::string& heading);
  void add_text(const std::string& paragraph);
  void add_figures(const std::vector<PageFigure>& figures);  ///< side by side where there is room
  void add_table(const PageTable& table);
  void add_folded(const std::string& summary, const std::string& text);  ///< to be opened

  /// Frames to be stepped through by buttons, a slider and the arrow keys; legends are of all.
  void add_strip(const std::vector<StripFrame>& frames, const std::vector<PageFigure>& legends);

  /// A scene that the mouse turns. Throws UsageError if a cloud has not as many normals and colours
  /// as points, or not as many colourings as the scene.
  void add_scene(const PageScene& scene);

  std::string html() const;

 private:
  std::string title_;
  std::string body_;
  bool has_strip_ = false;
  int scenes_ = 0;
};

}  // namespace tofmap

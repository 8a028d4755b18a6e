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

/// A picture on a page.
struct PageFigure {
  Picture picture;
  std::string caption;  ///< also the alternative text of the picture
};

/// A table on a page, with text in its cells.
struct PageTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< each as long as the header
};

/// A frame of a strip: several pictures of it and a remark.
struct StripFrame {
  std::string title;
  std::vector<PageFigure> panels;
  std::string remark;  ///< a sentence below the pictures; may be empty
};

/// A cloud in a 3D view.
struct SceneCloud {
  std::string name;
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Eigen::Vector3f> normals;     ///< one per point, of unit length; zero if unknown
  std::vector<std::vector<Rgb>> colorings;  ///< for each PageScene::colorings, one colour per point
};

/// A path in a 3D view.
struct ScenePath {
  std::string name;
  std::vector<Eigen::Vector3f> points_m;
  Rgb color;
};

/// A colouring of the clouds in a 3D view, and its legend.
struct SceneColoring {
  std::string name;
  Picture legend;
};

/// The contents of a 3D view. Clouds and paths are in the same frame, with z up. One cloud is shown
/// at a time.
struct PageScene {
  std::vector<SceneCloud> clouds;
  std::vector<ScenePath> paths;
  std::vector<SceneColoring> colorings;
  float point_size_m = 0.05F;  ///< width of a point
};

/// A report as a single HTML file, which contains its pictures, styles, scripts and points. Parts
/// appear in the order in which they are added. Texts are plain text, which the page escapes.
/// Without scripts, and in print, everything but the 3D view is visible.
class ReportPage {
 public:
  ReportPage(std::string title, const std::string& subtitle);

  /// Adds a coloured box with the verdict, followed by `sentence`.
  void add_verdict(Verdict verdict, const std::string& sentence);
  /// Adds a list of warnings. Adds nothing if it is empty.
  void add_warnings(const std::vector<std::string>& warnings);
  void add_heading(const std::string& heading);
  void add_text(const std::string& paragraph);
  /// Adds figures, side by side if the page is wide enough.
  void add_figures(const std::vector<PageFigure>& figures);
  void add_table(const PageTable& table);
  /// Adds preformatted text that is hidden until the reader opens its summary.
  void add_folded(const std::string& summary, const std::string& text);

  /// Adds frames that the reader steps through by buttons, a slider and the arrow keys, with
  /// legends below them. Adds nothing if there are no frames.
  void add_strip(const std::vector<StripFrame>& frames, const std::vector<PageFigure>& legends);

  /// Adds a 3D view that the reader rotates by the mouse. Throws UsageError if the normals, colours
  /// or colourings of a cloud have the wrong number, or its points or normals are not finite.
  void add_scene(const PageScene& scene);

  /// The HTML text of the page.
  std::string html() const;

 private:
  std::string title_;
  std::string body_;
  bool has_strip_ = false;
  int scenes_ = 0;
};

}  // namespace tofmap

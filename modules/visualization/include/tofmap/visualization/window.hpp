// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <tofmap/visualization/drawing.hpp>

namespace tofmap {

/// A window with a drawing in it, which the mouse turns (left button), shifts (middle) and zooms
/// (wheel or right); q or Escape closes it. It does nothing by itself: call handle_events() several
/// times a second, or run(). VTK wants all of its work, pictures included, on one thread.
class Window {
 public:
  /// Throws DrawingError if there is no display.
  explicit Window(const std::string& title, int width_px = 1280, int height_px = 800);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  /// Replaces what is to be seen. The view stays as it is.
  void show(const Drawing& drawing);

  void look_from(const Viewpoint& viewpoint);

  /// Whether the user has turned, shifted or zoomed since the last look_from().
  bool was_turned() const;

  /// Replaces the lines of text in the upper and the lower left corner.
  void set_text(const std::string& upper, const std::string& lower);

  /// Replaces the picture in the upper right corner; an empty one takes it away.
  void set_legend(const Picture& legend);

  /// Has a function called for keys other than those that close; names are those of X ("c",
  /// "Right", "space").
  void on_key(std::function<void(const std::string& key)> handler);

  /// Draws what is new and does what the user asked for meanwhile; false once it is closed.
  bool handle_events();

  /// Handles events until it is closed.
  void run();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tofmap

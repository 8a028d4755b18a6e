// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <tofmap/visualization/drawing.hpp>

namespace tofmap {

/// A window that shows a drawing. The mouse rotates (left button), pans (middle button) and zooms
/// (wheel or right button) the view; q or Escape closes the window. The caller must call
/// handle_events() several times a second, or run(). All windows and pictures must be made and used
/// by the same thread, which VTK requires.
class Window {
 public:
  /// Opens the window. Throws DrawingError if there is no display.
  explicit Window(const std::string& title, int width_px = 1280, int height_px = 800);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  /// Replaces the drawing. The viewpoint stays as it is.
  void show(const Drawing& drawing);

  /// Moves the view to a viewpoint.

  void look_from(const Viewpoint& viewpoint);

  /// Whether the user has rotated, panned or zoomed since the last look_from().
  bool was_moved() const;

  /// Replaces the text in the upper left and in the lower left corner.
  void set_text(const std::string& upper, const std::string& lower);

  /// Replaces the picture in the upper right corner. An empty picture removes it.
  void set_legend(const Picture& legend);

  /// Sets the function that is called for each key except q and Escape. Keys have their names in X:
  /// "c", "Right", "space".
  void on_key(std::function<void(const std::string& key)> handler);

  /// Draws changes and handles mouse and keys. Returns false once the window is closed.
  bool handle_events();

  /// Handles events until the window is closed.
  void run();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace tofmap::test {

/// A screen of its own, without a monitor, on which programs started meanwhile open their windows.
class VirtualDisplay {
 public:
  VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;
  ~VirtualDisplay();

  /// Whether there is one: this machine may have no Xvfb.
  bool is_there() const { return connection_ != nullptr; }

  /// Waits for a window of this title.
  bool has_window(const std::string& title) const;

  /// Presses a key in the window of this title until it is gone, for a window may not listen yet;
  /// false if it stays.
  bool close_by(const std::string& key, const std::string& title) const;

  /// Presses a key in the window of this title until what is on the screen changes; false if it
  /// stays as it is.
  bool changes_by(const std::string& key, const std::string& title) const;

  /// How many different colours are on the screen.
  int count_colors() const;

 private:
  std::vector<unsigned long> pixels() const;  ///< every fourth, in both directions
  std::optional<unsigned long> find(const std::string& title) const;
  void press(const std::string& key, unsigned long window) const;

  pid_t server_ = -1;
  void* connection_ = nullptr;  ///< Xlib's Display; its header stays out of here for its macros
};

}  // namespace tofmap::test

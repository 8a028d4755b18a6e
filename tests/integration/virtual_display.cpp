// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "virtual_display.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <set>
#include <thread>

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <support/waiting.hpp>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tofmap::test {
namespace {

/// In the child: a server that takes any free number and writes it there, and that goes with its
/// parent however that ends.
[[noreturn]] void become_server(int number_out) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  const std::string descriptor = std::to_string(number_out);
  execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", "1280x800x24",
         "-nolisten", "tcp", "-noreset", nullptr);
  _exit(127);
}

std::string read_line(int descriptor) {
  std::string line;
  for (char letter = 0; read(descriptor, &letter, 1) == 1 && letter != '\n';) line += letter;
  return line;
}

/// Windows may go while one asks for them, for which Xlib would end the test.
int pass_over(Display*, XErrorEvent*) { return 0; }

Display* display(void* connection) { return static_cast<Display*>(connection); }

}  // namespace

VirtualDisplay::VirtualDisplay() {
  int ends[2];
  if (pipe(ends) != 0) return;
  server_ = fork();
  if (server_ == 0) become_server(ends[1]);
  close(ends[1]);
  const std::string number = read_line(ends[0]);
  close(ends[0]);
  if (number.empty()) return;
  setenv("DISPLAY", (":" + number).c_str(), 1);
  connection_ = XOpenDisplay(nullptr);
  XSetErrorHandler(pass_over);
}

VirtualDisplay::~VirtualDisplay() {
  if (connection_) XCloseDisplay(display(connection_));
  unsetenv("DISPLAY");
  if (server_ <= 0) return;
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
}

std::optional<unsigned long> VirtualDisplay::find(const std::string& title) const {
  Display* screen = display(connection_);
  Window root = 0;
  Window parent = 0;
  Window* children = nullptr;
  unsigned count = 0;
  std::optional<unsigned long> found;
  if (!XQueryTree(screen, DefaultRootWindow(screen), &root, &parent, &children, &count)) return {};
  for (unsigned i = 0; i < count; ++i) {
    char* name = nullptr;
    if (XFetchName(screen, children[i], &name) && name == title) found = children[i];
    if (name) XFree(name);
  }
  if (children) XFree(children);
  return found;
}

bool VirtualDisplay::has_window(const std::string& title) const {
  return comes_true([&] { return find(title).has_value(); });
}

bool VirtualDisplay::close_by(const std::string& key, const std::string& title) const {
  return comes_true([&] {
    const auto window = find(title);
    if (window) press(key, *window);
    return !window;
  });
}

void VirtualDisplay::press(const std::string& key, unsigned long window) const {
  Display* screen = display(connection_);
  XEvent event{};
  event.xkey.type = KeyPress;
  event.xkey.display = screen;
  event.xkey.window = window;
  event.xkey.root = DefaultRootWindow(screen);
  event.xkey.same_screen = True;
  event.xkey.keycode = XKeysymToKeycode(screen, XStringToKeysym(key.c_str()));
  XSendEvent(screen, window, True, KeyPressMask, &event);
  XFlush(screen);
}

bool VirtualDisplay::changes_by(const std::string& key, const std::string& title) const {
  const std::vector<unsigned long> before = pixels();
  return comes_true([&] {
    const auto window = find(title);
    if (window) press(key, *window);
    constexpr std::chrono::milliseconds to_be_drawn(300);
    std::this_thread::sleep_for(to_be_drawn);
    return pixels() != before;
  });
}

std::vector<unsigned long> VirtualDisplay::pixels() const {
  Display* screen = display(connection_);
  constexpr unsigned width_px = 1280;
  constexpr unsigned height_px = 800;
  XImage* image =
      XGetImage(screen, DefaultRootWindow(screen), 0, 0, width_px, height_px, AllPlanes, ZPixmap);
  std::vector<unsigned long> pixels;
  for (unsigned y = 0; y < height_px; y += 4) {
    for (unsigned x = 0; x < width_px; x += 4) {
      pixels.push_back(XGetPixel(image, static_cast<int>(x), static_cast<int>(y)));
    }
  }
  XDestroyImage(image);
  return pixels;
}

int VirtualDisplay::count_colors() const {
  const std::vector<unsigned long> all = pixels();
  return static_cast<int>(std::set<unsigned long>(all.begin(), all.end()).size());
}

}  // namespace tofmap::test

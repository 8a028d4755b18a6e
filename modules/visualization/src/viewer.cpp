// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/viewer.hpp"

#include "renderer.hpp"

#include <X11/Xlib.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

namespace tofmap {
namespace {

/// VTK ends the program where X cannot be reached, so that is found out first.
void refuse_without_display() {
  Display* display = XOpenDisplay(nullptr);
  if (!display) throw DrawingError("there is no display to open a window on");
  XCloseDisplay(display);
}

}  // namespace

void show(const Drawing& drawing, const Viewpoint& viewpoint, const std::string& title) {
  refuse_without_display();
  vtkNew<vtkRenderWindow> window;
  window->SetSize(1280, 800);
  window->SetWindowName(title.c_str());
  window->AddRenderer(make_renderer(drawing, viewpoint));
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(window);
  vtkNew<vtkInteractorStyleTrackballCamera> style;
  interactor->SetInteractorStyle(style);
  window->Render();
  interactor->Start();
}

}  // namespace tofmap

// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/window.hpp"

#include "renderer.hpp"
#include "vtk_image.hpp"

#include <chrono>
#include <thread>
#include <utility>

#include <X11/Xlib.h>
#include <vtkActor2D.h>
#include <vtkCoordinate.h>
#include <vtkImageData.h>
#include <vtkImageMapper.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

namespace tofmap {
namespace {

struct CloseDisplay {
  void operator()(Display* display) const { XCloseDisplay(display); }
};
using OpenDisplay = std::unique_ptr<Display, CloseDisplay>;

/// Opens the display here, since VTK ends the program if it cannot connect to X. Throws
/// DrawingError.
OpenDisplay open_display() {
  OpenDisplay display(XOpenDisplay(nullptr));
  if (!display) throw DrawingError("there is no display to open a window on");
  return display;
}

/// Moves the camera by the mouse as VTK does, but passes keys to `on_key`.
class WindowStyle : public vtkInteractorStyleTrackballCamera {
 public:
  static WindowStyle* New();
  vtkTypeMacro(WindowStyle, vtkInteractorStyleTrackballCamera);

  void OnChar() override {}
  void OnKeyPress() override {
    if (on_key) on_key(Interactor->GetKeySym());
  }
  void StartState(int state) override {
    was_moved = true;
    vtkInteractorStyleTrackballCamera::StartState(state);
  }
  void OnMouseWheelForward() override {
    was_moved = true;
    vtkInteractorStyleTrackballCamera::OnMouseWheelForward();
  }
  void OnMouseWheelBackward() override {
    was_moved = true;
    vtkInteractorStyleTrackballCamera::OnMouseWheelBackward();
  }

  bool was_moved = false;
  std::function<void(const std::string&)> on_key;
};

vtkStandardNewMacro(WindowStyle);

/// Places a text in the upper (`y` = 1) or lower (`y` = 0) left corner of the window.
void hang(vtkTextActor& text, double y) {
  constexpr double margin = 0.01;
  text.GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  text.SetPosition(margin, y == 0 ? margin : 1 - margin);
  vtkTextProperty* style = text.GetTextProperty();
  style->SetFontFamilyToArial();
  style->SetFontSize(15);
  style->SetColor(0.15, 0.15, 0.15);
  style->SetBackgroundColor(1, 1, 1);
  style->SetBackgroundOpacity(0.7);
  y == 0 ? style->SetVerticalJustificationToBottom() : style->SetVerticalJustificationToTop();
}

}  // namespace

class Window::Impl {
 public:
  Impl(const std::string& title, int width_px, int height_px) {
    window_->SetDisplayId(display_.get());
    window_->SetSize(width_px, height_px);
    window_->SetWindowName(title.c_str());
    window_->SetMultiSamples(0);
    hang(*upper_, 1);
    hang(*lower_, 0);
    legend_image_->SetColorWindow(255);
    legend_image_->SetColorLevel(127.5);
    legend_->SetMapper(legend_image_);
    set_legend({});
    show({});
    window_->AddRenderer(renderer_);
    interactor_->SetRenderWindow(window_);
    interactor_->SetInteractorStyle(style_);
    style_->on_key = [this](const std::string& key) { take_key(key); };
    interactor_->Initialize();
  }

  void show(const Drawing& drawing) {
    replace_drawing(*renderer_, drawing);
    renderer_->AddViewProp(upper_);
    renderer_->AddViewProp(lower_);
    renderer_->AddViewProp(legend_);
    is_drawn_ = false;
  }

  void look_from(const Viewpoint& viewpoint) {
    tofmap::look_from(*renderer_, viewpoint);
    style_->was_moved = false;
    is_drawn_ = false;
  }

  bool was_moved() const { return style_->was_moved; }

  void set_text(const std::string& upper, const std::string& lower) {
    upper_->SetInput(upper.c_str());
    lower_->SetInput(lower.c_str());
    is_drawn_ = false;
  }

  void set_legend(const Picture& legend) {
    legend_->SetVisibility(legend.pixels.empty() ? 0 : 1);
    if (!legend.pixels.empty()) {
      legend_image_->SetInputData(vtk_image(legend));
      legend_size_px_ = Eigen::Vector2i(legend.width_px, legend.height_px);
    }
    is_drawn_ = false;
  }

  void on_key(std::function<void(const std::string&)> handler) { handler_ = std::move(handler); }

  bool handle_events() {
    if (!interactor_->GetDone() && !std::exchange(is_drawn_, true)) {
      place_legend();
      window_->Render();
    }
    interactor_->ProcessEvents();
    window_->ReleaseCurrent();  // draw() uses another OpenGL context in between
    return !interactor_->GetDone();
  }

 private:
  /// Moves the legend to the upper right corner of the window at its current size.
  void place_legend() {
    constexpr int margin_px = 10;
    const int* size_px = window_->GetSize();
    legend_->SetPosition(size_px[0] - legend_size_px_.x() - margin_px,
                         size_px[1] - legend_size_px_.y() - margin_px);
  }

  void take_key(const std::string& key) {
    if (key == "q" || key == "Escape") {
      interactor_->TerminateApp();
    } else if (handler_) {
      handler_(key);
    }
  }

  OpenDisplay display_ = open_display();
  vtkNew<vtkRenderWindow> window_;
  vtkSmartPointer<vtkRenderer> renderer_ = make_renderer({}, {});
  vtkNew<vtkRenderWindowInteractor> interactor_;
  vtkNew<WindowStyle> style_;
  vtkNew<vtkTextActor> upper_;
  vtkNew<vtkTextActor> lower_;
  vtkNew<vtkImageMapper> legend_image_;
  vtkNew<vtkActor2D> legend_;
  Eigen::Vector2i legend_size_px_ = Eigen::Vector2i::Zero();
  std::function<void(const std::string&)> handler_;
  bool is_drawn_ = false;  ///< whether all changes have been drawn
};

Window::Window(const std::string& title, int width_px, int height_px)
    : impl_(std::make_unique<Impl>(title, width_px, height_px)) {}

Window::~Window() = default;

void Window::show(const Drawing& drawing) { impl_->show(drawing); }

void Window::look_from(const Viewpoint& viewpoint) { impl_->look_from(viewpoint); }

bool Window::was_moved() const { return impl_->was_moved(); }

void Window::set_text(const std::string& upper, const std::string& lower) {
  impl_->set_text(upper, lower);
}

void Window::set_legend(const Picture& legend) { impl_->set_legend(legend); }

void Window::on_key(std::function<void(const std::string&)> handler) {
  impl_->on_key(std::move(handler));
}

bool Window::handle_events() { return impl_->handle_events(); }

void Window::run() {
  constexpr std::chrono::milliseconds a_screen_refresh(16);
  while (handle_events()) std::this_thread::sleep_for(a_screen_refresh);
}

}  // namespace tofmap

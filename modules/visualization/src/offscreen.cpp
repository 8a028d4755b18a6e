// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Debian's VTK can open windows only through X. To draw without a display, this file uses a VTK
// window class that works in an OpenGL context of the caller: here one of EGL, without a surface.

#include "offscreen.hpp"

#include "renderer.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkWindowToImageFilter.h>
#include <vtk_glew.h>

namespace tofmap {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw DrawingError("cannot draw without a display: " + what +
                     "; install the packages libegl1 and libgl1-mesa-dri");
}

/// An OpenGL context without a window or surface, which is current during the lifetime of this.
class SurfacelessContext {
 public:
  SurfacelessContext() : display_(open_display()) {
    if (!eglBindAPI(EGL_OPENGL_API)) fail("EGL has no OpenGL");
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display_, wanted, &config, 1, &count) || count == 0) {
      fail("EGL offers no configuration");
    }
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 2, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT) fail("there is no OpenGL 3.2");
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      eglDestroyContext(display_, context_);
      fail("the OpenGL context cannot be used");
    }
  }
  SurfacelessContext(const SurfacelessContext&) = delete;
  SurfacelessContext& operator=(const SurfacelessContext&) = delete;
  ~SurfacelessContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }

 private:
  /// The display is never closed, since EGL returns the same one every time.
  static EGLDisplay open_display() {
    const auto get_platform_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (!get_platform_display) fail("EGL does not support platforms");
    EGLDisplay display =
        get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) {
      fail("there is no surfaceless EGL display");
    }
    return display;
  }

  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

/// A VTK window that draws in the current OpenGL context.
class OffscreenWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static OffscreenWindow* New();
  vtkTypeMacro(OffscreenWindow, vtkGenericOpenGLRenderWindow);

  /// Ignores the error that Debian's GLEW reports if there is no X display, at which VTK would
  /// stop. GLEW has found all functions of OpenGL before that.
  void OpenGLInitContext() override {
    ContextCreationTime.Modified();
    if (Initialized) return;
    glewInit();
    GlewInitValid = true;  // the context was created for OpenGL 3.2
    Initialized = true;
  }

  bool IsCurrent() override { return true; }
};

vtkStandardNewMacro(OffscreenWindow);

Picture grab(vtkRenderWindow& window) {
  vtkNew<vtkWindowToImageFilter> filter;
  filter->SetInput(&window);
  filter->SetInputBufferTypeToRGB();
  filter->ReadFrontBufferOff();
  filter->Update();
  vtkImageData* image = filter->GetOutput();
  const int* size = image->GetDimensions();
  Picture picture(size[0], size[1]);
  for (int y = 0; y < size[1]; ++y) {
    // VTK counts rows from the bottom.
    const auto* row =
        static_cast<const unsigned char*>(image->GetScalarPointer(0, size[1] - 1 - y, 0));
    for (int x = 0; x < size[0]; ++x, row += 3) picture.at(x, y) = {row[0], row[1], row[2]};
  }
  return picture;
}

}  // namespace

Picture picture_of(vtkRenderer& renderer, int width_px, int height_px) {
  const SurfacelessContext context;
  vtkNew<OffscreenWindow> window;
  window->SetReadyForRendering(true);
  window->SetSize(width_px, height_px);
  window->SetMultiSamples(0);
  window->AddRenderer(&renderer);
  window->Render();
  return grab(*window);
}

Picture draw(const Drawing& drawing, const Viewpoint& viewpoint, int width_px, int height_px) {
  const auto renderer = make_renderer(drawing, viewpoint);
  return picture_of(*renderer, width_px, height_px);
}

}  // namespace tofmap

// Asks EGL for a context step by step, and says which step it refuses.
#include "hal/sim/off_screen.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <memory>
#include <utility>

namespace eciton::hal::sim {

/// The few calls that are used, of a library that is never unloaded: Mesa does not like it.
struct OffScreenContext::Egl {
  PFNEGLGETPLATFORMDISPLAYPROC get_platform_display = nullptr;
  PFNEGLINITIALIZEPROC initialize = nullptr;
  PFNEGLBINDAPIPROC bind_api = nullptr;
  PFNEGLCHOOSECONFIGPROC choose_config = nullptr;
  PFNEGLCREATECONTEXTPROC create_context = nullptr;
  PFNEGLMAKECURRENTPROC make_current = nullptr;
  PFNEGLDESTROYCONTEXTPROC destroy_context = nullptr;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

namespace {

template <class Function>
bool load(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(library, name));
  return function != nullptr;
}

Error refused(const std::string& what) { return Error{"no pictures: " + what}; }

}  // namespace

Result<OffScreenContext> OffScreenContext::open(const std::string& egl_library) {
  void* library = ::dlopen(egl_library.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (library == nullptr) {
    return refused(egl_library + " cannot be loaded; Debian's packages libegl1 and libgl1-mesa-dri bring it");
  }
  auto egl = std::make_unique<Egl>();
  if (!load(library, "eglGetPlatformDisplay", egl->get_platform_display) ||
      !load(library, "eglInitialize", egl->initialize) || !load(library, "eglBindAPI", egl->bind_api) ||
      !load(library, "eglChooseConfig", egl->choose_config) ||
      !load(library, "eglCreateContext", egl->create_context) ||
      !load(library, "eglMakeCurrent", egl->make_current) ||
      !load(library, "eglDestroyContext", egl->destroy_context)) {
    return refused(egl_library + " is no EGL 1.5");
  }
  egl->display = egl->get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (egl->display == EGL_NO_DISPLAY || !egl->initialize(egl->display, nullptr, nullptr)) {
    return refused("EGL has no surfaceless display; Debian's package libgl1-mesa-dri brings one");
  }
  const EGLint wanted[] = {EGL_RED_SIZE,
                           8,
                           EGL_GREEN_SIZE,
                           8,
                           EGL_BLUE_SIZE,
                           8,
                           EGL_ALPHA_SIZE,
                           8,
                           EGL_DEPTH_SIZE,
                           24,
                           EGL_STENCIL_SIZE,
                           8,
                           EGL_SURFACE_TYPE,
                           EGL_PBUFFER_BIT,
                           EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_BIT,
                           EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (!egl->choose_config(egl->display, wanted, &config, 1, &configs) || configs < 1) {
    return refused("EGL has no configuration with 24 bits of depth for OpenGL");
  }
  if (!egl->bind_api(EGL_OPENGL_API)) return refused("EGL does not know OpenGL");
  egl->context = egl->create_context(egl->display, config, EGL_NO_CONTEXT, nullptr);
  if (egl->context == EGL_NO_CONTEXT) return refused("EGL makes no OpenGL context");
  OffScreenContext out;
  out.egl_ = egl.release();
  if (!out.egl_->make_current(out.egl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, out.egl_->context)) {
    return refused("EGL cannot use its context without a surface");
  }
  return out;
}

OffScreenContext::OffScreenContext(OffScreenContext&& other) noexcept : egl_(std::exchange(other.egl_, nullptr)) {}

OffScreenContext& OffScreenContext::operator=(OffScreenContext&& other) noexcept {
  std::swap(egl_, other.egl_);
  return *this;
}

OffScreenContext::~OffScreenContext() {
  if (egl_ == nullptr) return;
  // The display stays initialized: whoever else uses it in this process shares it.
  egl_->make_current(egl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  egl_->destroy_context(egl_->display, egl_->context);
  delete egl_;
}

}  // namespace eciton::hal::sim

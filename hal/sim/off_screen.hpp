// An OpenGL context without a screen: EGL on Mesa's surfaceless platform, loaded when it is asked for, so that
// everything else runs on a machine that has none.
#pragma once

#include <string>

#include "core/base/result.hpp"

namespace eciton::hal::sim {

/// Current on the thread that opened it, until it is destroyed.
class OffScreenContext {
 public:
  /// The Error names what is missing.
  static Result<OffScreenContext> open(const std::string& egl_library);
  ~OffScreenContext();
  OffScreenContext(OffScreenContext&& other) noexcept;
  OffScreenContext& operator=(OffScreenContext&& other) noexcept;

 private:
  struct Egl;
  OffScreenContext() = default;

  Egl* egl_ = nullptr;
};

}  // namespace eciton::hal::sim

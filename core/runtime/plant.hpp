// The world as a simulation executor sees it: something that moves on when told.
#pragma once

#include "core/base/time.hpp"

namespace eciton::runtime {

class Plant {
 public:
  virtual ~Plant() = default;
  /// Moves the world on to `until`, with the actuator commands it holds now.
  virtual void advance(TimePoint until) = 0;
};

}  // namespace eciton::runtime

// Makes a change of what a feed-forward wrench comes from bumpless: what was in force at the change and is not given
// any more fades out.
#pragma once

#include <cmath>

#include "core/robot/frames.hpp"

namespace eciton::control {

/// Real-time safe; one thread.
class HandOver {
 public:
  explicit HandOver(double time_constant_s = 1.0) : time_constant_s_(time_constant_s) {}

  /// The next update's wrench comes from elsewhere.
  void begin() { changing_ = true; }
  /// Nothing is in force.
  void reset() { in_force_W_ = left_W_ = {}; }

  /// What is given now; returns what shall be in force.
  robot::Wrench update(const robot::Wrench& given_W, double dt_s) {
    left_W_ = changing_ ? in_force_W_ - given_W : left_W_ * std::exp(-dt_s / time_constant_s_);
    changing_ = false;
    in_force_W_ = given_W + left_W_;
    return in_force_W_;
  }

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.in_force_W_, self.left_W_, self.changing_);
  }

 private:
  double time_constant_s_;
  robot::Wrench in_force_W_, left_W_;
  bool changing_ = false;
};

}  // namespace eciton::control

// The moments that an experiment kept, as pictures.
#pragma once

#include <string>
#include <vector>

#include "core/robot/airframe.hpp"
#include "deploy/experiments/experiment.hpp"

namespace eciton::deploy {

struct Picture {
  std::string title;
  double time_s;
  std::string png;  // the file's bytes
};

struct Pictures {
  std::vector<Picture> pictures;
  std::string notice;   // why there are none, or fewer than moments; empty: all is there
  std::string colours;  // "module 1 blue, 2 orange"
};

/// `egl_library`: what CameraConfig takes.
Pictures render_stills(const std::vector<Still>& stills, const robot::Airframe& airframe,
                       const std::string& egl_library);

}  // namespace eciton::deploy

// What a person sees while a demo runs: a few lines refreshed in place on a terminal, else lines on change.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "core/base/time.hpp"

namespace eciton::deploy {

struct DemoViewLine {
  std::string module;  // "m1"
  std::string flight_mode;
  std::string docking;  // phase and gap; the gap is not shown where there is only change to show
  std::string gap;
  std::string chain;    // "1-2-3"
  std::string latched;  // by the physics
};

class DemoView {
 public:
  explicit DemoView(std::FILE* out);
  ~DemoView();

  /// A new step of the flight.
  void step(const std::string& what, double simulated_s);
  /// A line that stays.
  void say(const std::string& line);
  /// As often as one likes: draws when it is time or when something changed.
  void refresh(double simulated_s, double speed_factor, const std::vector<DemoViewLine>& lines, Duration monotonic);

 private:
  void erase();

  std::FILE* out_;
  bool terminal_;
  std::string step_;
  std::size_t drawn_ = 0;  // lines now on the terminal
  Duration drawn_at_{};
  std::vector<std::string> last_;
};

}  // namespace eciton::deploy

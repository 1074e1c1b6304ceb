// Two ANSI sequences, line up and erase line, are all a terminal needs here.
#include "deploy/command/demo_view.hpp"

#include <unistd.h>

namespace eciton::deploy {
namespace {

constexpr Duration redraw = std::chrono::milliseconds(200);

std::string state_of(const DemoViewLine& line) {
  char text[160];
  std::snprintf(text, sizeof text, "%-5s %-9s %-10s %-14s %s", line.module.c_str(), line.flight_mode.c_str(),
                line.docking.c_str(), line.chain.c_str(), line.latched.c_str());
  return text;
}

}  // namespace

DemoView::DemoView(std::FILE* out) : out_(out), terminal_(::isatty(::fileno(out)) != 0) {}

DemoView::~DemoView() { std::fflush(out_); }

void DemoView::erase() {
  for (; drawn_ > 0; --drawn_) std::fputs("\x1b[1A\x1b[2K", out_);
}

void DemoView::step(const std::string& what, double simulated_s) {
  step_ = what;
  char text[160];
  std::snprintf(text, sizeof text, "%6.1f s  %s", simulated_s, what.c_str());
  say(text);
}

void DemoView::say(const std::string& line) {
  erase();
  std::fprintf(out_, "%s\n", line.c_str());
  std::fflush(out_);
  drawn_at_ = {};
}

void DemoView::refresh(double simulated_s, double speed_factor, const std::vector<DemoViewLine>& lines,
                       Duration monotonic) {
  if (terminal_) {
    if (monotonic - drawn_at_ < redraw) return;
    erase();
    drawn_at_ = monotonic;
    std::fprintf(out_, "%6.1f s  %.2f x real time  %s\n", simulated_s, speed_factor, step_.c_str());
    for (const DemoViewLine& line : lines) {
      std::fprintf(out_, "          %s %s\n", state_of(line).c_str(), line.gap.c_str());
    }
    drawn_ = lines.size() + 1;
    std::fflush(out_);
    return;
  }
  last_.resize(lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::string state = state_of(lines[k]);
    if (state == last_[k]) continue;
    last_[k] = state;
    std::fprintf(out_, "%6.1f s    %s\n", simulated_s, state.c_str());
    std::fflush(out_);
  }
}

}  // namespace eciton::deploy

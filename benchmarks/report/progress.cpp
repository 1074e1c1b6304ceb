// How far a measurement is, on one line of the terminal.
#include <unistd.h>

#include <cstdio>
#include <utility>

#include "benchmarks/report/result.hpp"

namespace eciton::bench {

ProgressLine::ProgressLine(std::string command) : command_(std::move(command)), live_(::isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (live_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::show(std::size_t finished, std::size_t all, double left_s, const std::string& doing) {
  if (!live_) return;
  std::fprintf(stderr, "\r\033[K%s: %zu of %zu, %.0f s left: %s", command_.c_str(), finished, all, left_s,
               doing.c_str());
}

}  // namespace eciton::bench

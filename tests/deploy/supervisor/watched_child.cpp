// A child with a working loop and a watchdog, as Eciton's programs have: it does as it is told.
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

#include "core/runtime/watchdog.hpp"

namespace {

using namespace std::chrono_literals;

/// works; stops itself (as a SIGSTOP would); deadlocks; never becomes ready.
int run(const std::string& what) {
  eciton::runtime::LoopProgress turns;
  eciton::runtime::Watchdog watchdog([&] {
    if (!turns.has_turned()) return std::string_view("the loop");
    turns.note();
    return std::string_view();
  });
  if (what == "starts") std::this_thread::sleep_for(60s);
  for (int k = 0;; ++k) {
    turns.turn();
    std::this_thread::sleep_for(5ms);
    if (k != 60 || what == "works") continue;
    std::printf("about to hang\n");
    std::fflush(stdout);
    if (what == "stops") std::raise(SIGSTOP);
    if (what == "deadlocks") std::this_thread::sleep_for(60s);
  }
}

}  // namespace

int main(int, char** argv) { return run(argv[1]); }

// Asks by a file in the runtime directory, and waits until its lock is free: no process id can be mistaken.
#include "deploy/command/down.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "core/base/wall_clock.hpp"
#include "deploy/supervisor/runtime_directory.hpp"

namespace eciton::deploy {
namespace {

struct DownOptions {
  std::vector<std::string> names;
  double timeout_s = 15;
};

std::vector<HeldDirectory> chosen(const std::vector<std::string>& names) {
  const std::vector<HeldDirectory> held = held_directories();
  if (names.empty()) return held;
  std::vector<HeldDirectory> result;
  for (const std::string& name : names) {
    const auto found = std::find_if(held.begin(), held.end(), [&](const auto& h) { return h.name == name; });
    if (found == held.end()) {
      std::string running;
      for (const HeldDirectory& h : held) running += (running.empty() ? "" : ", ") + h.name;
      throw BadInput{{"'" + name + "' is not running; running here (" + runtime_root().string() +
                      "): " + (running.empty() ? "nothing" : running)}};
    }
    result.push_back(*found);
  }
  return result;
}

int bring_down(const DownOptions& options) {
  const std::vector<HeldDirectory> directories = chosen(options.names);
  if (directories.empty()) {
    std::printf("nothing is running (%s)\n", runtime_root().c_str());
    return 0;
  }
  for (const HeldDirectory& directory : directories) ok_or_throw(request_stop(directory));
  const Duration end = monotonic_now() + from_s(options.timeout_s);
  bool all_down = true;
  for (const HeldDirectory& directory : directories) {
    while (is_held(directory.path) && monotonic_now() < end) std::this_thread::sleep_for(20ms);
    const bool down = !is_held(directory.path);
    all_down = all_down && down;
    if (down) {
      std::printf("%s is down\n", directory.name.c_str());
    } else {
      std::fprintf(stderr, "%s is still up after %g s: process %d does not answer\n", directory.name.c_str(),
                   options.timeout_s, static_cast<int>(directory.holder));
    }
  }
  return all_down ? 0 : 1;
}

}  // namespace

void add_down(CLI::App& app, Run& run) {
  const auto options = std::make_shared<DownOptions>();
  CLI::App* sub = app.add_subcommand("down", "end what 'eciton up' runs on this host");
  sub->add_option("NAME", options->names, "modules, as 'eciton status' names them (default: all)");
  sub->add_option("--timeout", options->timeout_s, "wait so long, s")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  on_chosen(*sub, run, [options] { return bring_down(*options); });
}

}  // namespace eciton::deploy

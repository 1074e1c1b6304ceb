// All or nothing, and one poll for all.
#include "deploy/supervisor/launch_loop.hpp"

#include <algorithm>

#include "core/base/wall_clock.hpp"

namespace eciton::deploy {

Result<Launches> claim_all(const std::vector<LaunchPlan>& plans) {
  Launches launches;
  for (const LaunchPlan& plan : plans) {
    auto launch = Launch::claim(plan);
    if (!launch) return launch.error();
    launches.push_back(std::move(launch).value());
  }
  return launches;
}

Status start_all(Launches& launches) {
  for (const auto& launch : launches) {
    if (const Status status = launch->start(); !status) return status;
  }
  return ok();
}

void stop_all(Launches& launches) {
  for (const auto& launch : launches) launch->supervisor().request_stop();
  for (const auto& launch : launches) launch->supervisor().stop_all();
}

void watch(Launches& launches, const std::vector<int>& extra_descriptors, Duration timeout,
           const std::function<void(Launch&, const ChildReport&)>& on_end) {
  std::vector<pollfd> descriptors;
  for (const int fd : extra_descriptors) descriptors.push_back({fd, POLLIN, 0});
  Duration wait = timeout;
  for (const auto& launch : launches) {
    launch->supervisor().add_descriptors(descriptors);
    if (const auto restart = launch->supervisor().next_restart()) wait = std::min(wait, *restart - monotonic_now());
  }
  wait_for(descriptors, wait);
  for (const auto& launch : launches) {
    launch->check([&](const ChildReport& report) { on_end(*launch, report); });
  }
}

std::string describe(const Launch& launch, const ChildReport& report) {
  std::string text = launch.plan().name + "/" + report.name + ": ";
  text += report.hung ? "it hung and was killed" : "it ended with " + report.last_end->text();
  if (!report.last_words.empty()) text += ": " + report.last_words;
  return text;
}

}  // namespace eciton::deploy

// The waiting that the operator itself never does.
#include "deploy/operator/follow.hpp"

#include <poll.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "core/base/wall_clock.hpp"

namespace eciton::deploy {
namespace {

constexpr Duration pace = std::chrono::milliseconds(20);
constexpr int wall_time_factor = 10;  // simulated time may run slowly

/// Prints each goal's progress once.
class Narrator {
 public:
  void tell(const GoalReport& report) {
    const auto [told, is_new] = told_.try_emplace(report.correlation_id, GoalProgress::unsent);
    if (told->second == report.progress) return;
    told->second = report.progress;
    if (report.progress == GoalProgress::unanswered) return;
    const bool bad = report.progress == GoalProgress::refused || report.progress == GoalProgress::aborted;
    std::fprintf(bad ? stderr : stdout, "%s\n", describe(report).c_str());
    std::fflush(stdout);
  }

 private:
  std::map<std::uint64_t, GoalProgress> told_;
};

void wait(bus::Participant& swarm, const runtime::StopFlag& stop) {
  pollfd descriptors[] = {{swarm.waker().file_descriptor(), POLLIN, 0}, {stop.file_descriptor(), POLLIN, 0}};
  const timespec t{0, static_cast<long>(pace.count())};
  ::ppoll(descriptors, 2, &t, nullptr);
  swarm.waker().clear();
}

std::string seconds_text(Duration d) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", to_s(d));
  return text;
}

void give_up(Operator& op, const std::vector<std::uint64_t>& goals, const std::string& why) {
  for (const std::uint64_t id : goals) {
    const GoalReport& report = *op.report(id);
    if (is_over(report.progress)) continue;
    const char* reason =
        report.progress == GoalProgress::accepted ? "it was accepted, but is not done" : report.reason.c_str();
    std::fprintf(stderr, "%s: %s: %s\n", report.what.c_str(), why.c_str(), reason);
    op.give_up(id);
  }
}

}  // namespace

std::string describe(const GoalReport& report) {
  std::string text = report.what + ": " + std::string(to_string(report.progress));
  if (report.progress == GoalProgress::succeeded)
    text += " after " + seconds_text(report.ended_at - report.accepted_at);
  if (!report.reason.empty() && report.progress != GoalProgress::accepted) text += ": " + report.reason;
  return text;
}

Followed follow(Operator& op, bus::Participant& swarm, const std::vector<std::uint64_t>& goals,
                const FollowConfig& config, const runtime::StopFlag& stop) {
  Narrator narrator;
  const Duration begin = monotonic_now();
  std::optional<TimePoint> sent_at;  // all of them, on the modules' clock
  while (!stop.requested()) {
    op.poll(wall_now());
    bool all_sent = true, all_over = true, all_well = true;
    for (const std::uint64_t id : goals) {
      const GoalReport& report = *op.report(id);
      narrator.tell(report);
      all_sent = all_sent && report.progress != GoalProgress::unsent;
      all_over = all_over && is_over(report.progress);
      all_well = all_well && report.progress == GoalProgress::succeeded;
    }
    if (all_over) return all_well ? Followed::succeeded : Followed::failed;
    const Duration waited = monotonic_now() - begin;
    if (all_sent && !sent_at) sent_at = op.module_now();
    if (!sent_at && waited > config.hearing_timeout) {
      give_up(op, goals, "not sent within " + seconds_text(config.hearing_timeout));
      return Followed::failed;
    }
    const bool late = sent_at && op.module_now() - *sent_at > config.timeout;
    if (late || waited > wall_time_factor * config.timeout) {
      give_up(op, goals, "not done within " + seconds_text(config.timeout));
      return Followed::failed;
    }
    wait(swarm, stop);
  }
  give_up(op, goals, "no longer followed");
  return Followed::interrupted;
}

}  // namespace eciton::deploy

// Start, listen, kill, restart, stop.
#include "deploy/supervisor/supervisor.hpp"

#include <algorithm>
#include <csignal>
#include <ctime>

#include "core/base/wall_clock.hpp"

namespace eciton::deploy {
namespace {

constexpr int bad_input = 2;
constexpr int checks_least = 4;  // in which a child was silent before it counts as hung, however long they took

Duration monotonic() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
}

/// What sd_notify(3) and sd_watchdog_enabled(3) ask for; nothing of our own supervisor's.
std::vector<std::pair<std::string, std::string>> environment_of(const ChildSpec& spec,
                                                                const std::optional<NotifySocket>& notify) {
  auto environment = spec.environment;
  const auto limit_us = std::chrono::duration_cast<std::chrono::microseconds>(spec.watchdog).count();
  environment.emplace_back("NOTIFY_SOCKET", notify ? notify->path().string() : "");
  environment.emplace_back("WATCHDOG_USEC", notify ? std::to_string(limit_us) : "");
  environment.emplace_back("WATCHDOG_PID", "");
  return environment;
}

}  // namespace

Supervisor::Supervisor(SupervisorConfig config, Clock clock)
    : config_(std::move(config)), clock_(clock ? std::move(clock) : monotonic) {}

Supervisor::~Supervisor() { stop_all(); }

Status Supervisor::start(const ChildSpec& spec) {
  auto child = std::make_unique<Child>();
  child->spec = spec;
  child->report.name = spec.name;
  if (spec.watchdog > Duration::zero()) {
    Result<NotifySocket> notify = NotifySocket::open(config_.log_directory / (spec.name + ".notify"));
    if (!notify) return notify.error();
    child->notify.emplace(std::move(notify).value());
  }
  if (const Status status = launch(*child); !status) return status;
  children_.push_back(std::move(child));
  return ok();
}

Status Supervisor::launch(Child& child) {
  if (child.notify) child.notify->take();  // the last words of the one before
  Result<ChildProcess> process = ChildProcess::start({.arguments = child.spec.arguments,
                                                      .environment = environment_of(child.spec, child.notify),
                                                      .log_file = log_file(child.spec.name),
                                                      .network_namespace = child.spec.network_namespace});
  if (!process) return process.error();
  child.ready = child.stopping = child.killed = false;
  child.silent = {};
  child.process.emplace(std::move(process).value());
  child.report.pid = child.process->pid();
  child.report.state = ChildState::running;
  child.started = clock_();
  return ok();
}

void Supervisor::note_end(Child& child, const ProcessEnd& end) {
  const Duration now = clock_();
  child.process.reset();
  child.report.last_end = end;
  child.report.hung = child.killed;
  if (child.killed) ++child.report.hangs;
  const auto lines = last_lines(log_file(child.spec.name), 1);
  child.report.last_words = lines.empty() ? "" : lines.back();
  if (end.signal == 0 && end.exit_status == bad_input) {
    child.report.state = ChildState::refused;
    return;
  }
  child.report.state = ChildState::waiting;
  // What ends for the first time is needed back at once, and faults come in company; what keeps ending waits longer
  // each time.
  if (now - child.started >= config_.steady) {
    child.restarts_in_a_row = 0;
    child.backoff = {};
  }
  child.restart_at = now + child.backoff;
  if (++child.restarts_in_a_row < config_.at_once) return;
  child.backoff = std::clamp(2 * child.backoff, config_.backoff_min, config_.backoff_max);
}

void Supervisor::listen_to(Child& child, Duration since_last_check) {
  if (!child.notify || child.killed) return;
  const NotifySocket::Notices said = child.notify->take();
  child.ready = child.ready || said.ready;
  child.stopping = child.stopping || said.stopping;
  if (said.ready || said.alive || said.stopping) {
    child.silent = {};
    return;
  }
  if (!child.ready) return;
  const Duration counts_most = std::min(config_.silence_per_check_max, child.spec.watchdog / checks_least);
  child.silent += std::clamp(since_last_check, Duration::zero(), counts_most);
  if (child.silent <= (child.stopping ? config_.stop_patience : child.spec.watchdog)) return;
  child.killed = true;
  child.process->signal(SIGKILL);  // its end is taken when the kernel tells of it
}

void Supervisor::check(const std::function<void(const ChildReport&)>& on_end) {
  const Duration begin = clock_();
  const Duration since_last_check = begin - last_check_.value_or(begin);
  last_check_ = begin;
  for (const auto& child : children_) {
    if (child->process) {
      const auto end = child->process->take_end();
      if (!end) {
        listen_to(*child, since_last_check);
        continue;
      }
      note_end(*child, *end);
      if (on_end) on_end(child->report);
    } else if (child->report.state == ChildState::waiting && clock_() >= child->restart_at) {
      ++child->report.restarts;
      if (const Status status = launch(*child); !status) {
        child->report.last_words = status.error().message;
        child->restart_at = clock_() + child->backoff;
        child->backoff = std::min(2 * child->backoff, config_.backoff_max);
      }
    }
  }
}

void Supervisor::add_descriptors(std::vector<pollfd>& descriptors) const {
  for (const auto& child : children_) {
    if (child->process) descriptors.push_back({child->process->file_descriptor(), POLLIN, 0});
  }
}

std::optional<Duration> Supervisor::next_restart() const {
  std::optional<Duration> next;
  for (const auto& child : children_) {
    if (child->report.state != ChildState::waiting) continue;
    if (!next || child->restart_at < *next) next = child->restart_at;
  }
  return next;
}

void Supervisor::request_stop() {
  if (stop_requested_at_) return;
  stop_requested_at_ = monotonic();
  for (const auto& child : children_) {
    if (!child->process) continue;
    child->process->signal(SIGTERM);
    child->process->signal(SIGCONT);  // a stopped one hears nothing else
  }
}

void Supervisor::stop_all() {
  request_stop();
  const Duration patience_end = *stop_requested_at_ + config_.stop_patience;
  while (true) {
    std::vector<pollfd> descriptors;
    for (const auto& child : children_) {
      if (!child->process) continue;
      if (const auto end = child->process->take_end()) {
        child->report.last_end = *end;
        child->process.reset();
      } else {
        descriptors.push_back({child->process->file_descriptor(), POLLIN, 0});
      }
    }
    const Duration left = patience_end - monotonic();
    if (descriptors.empty() || left <= Duration::zero()) break;
    wait_for(descriptors, left);
  }
  for (const auto& child : children_) {
    if (child->process) child->report.last_end = ProcessEnd{.signal = SIGKILL};
    child->process.reset();  // kills and reaps it
    child->report.state = ChildState::stopped;
  }
  stop_requested_at_.reset();
}

std::vector<ChildReport> Supervisor::reports() const {
  std::vector<ChildReport> reports;
  for (const auto& child : children_) reports.push_back(child->report);
  return reports;
}

bool Supervisor::all_running() const {
  return std::all_of(children_.begin(), children_.end(),
                     [](const auto& child) { return child->report.state == ChildState::running; });
}

void wait_for(std::vector<pollfd>& descriptors, Duration timeout) {
  const timespec t = to_timespec(timeout);
  ::ppoll(descriptors.data(), descriptors.size(), &t, nullptr);
}

}  // namespace eciton::deploy

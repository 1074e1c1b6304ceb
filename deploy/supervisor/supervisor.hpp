// Keeps a set of child processes running: kills what hangs, restarts what ends, with a back-off; ends them all in a
// bounded time. One thread; it never waits except in stop_all.
#pragma once

#include <poll.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deploy/supervisor/child_process.hpp"
#include "deploy/supervisor/notify_socket.hpp"

namespace eciton::deploy {

struct ChildSpec {
  std::string name;  // also of its log file
  std::vector<std::string> arguments;
  std::vector<std::pair<std::string, std::string>> environment{};
  std::filesystem::path network_namespace{};  // empty: the supervisor's
  Duration
      watchdog{};  // one that once said READY=1 says WATCHDOG=1 as often (sd_notify(3)), or hangs; 0: may be mute
};

struct SupervisorConfig {
  std::filesystem::path log_directory;                    // of notify sockets too
  std::uint32_t at_once = 3;                              // so many restarts come at once, the next ...
  Duration backoff_min = std::chrono::milliseconds(250);  // ... after this, ...
  Duration backoff_max = std::chrono::seconds(5);         // ... which doubles with each, up to this
  Duration steady = std::chrono::seconds(10);             // the next restart of one that ran so long is a first one
  Duration stop_patience = std::chrono::seconds(5);       // from SIGTERM, or its own STOPPING=1, to SIGKILL
  // A child's silence between two checks counts as at most this: what holds up the supervisor holds up others too.
  Duration silence_per_check_max = std::chrono::milliseconds(100);
};

enum class ChildState {
  running,
  waiting,  // for its restart
  refused,  // exit status 2, bad input: another start would end alike
  stopped
};

struct ChildReport {
  std::string name;
  ChildState state = ChildState::stopped;
  pid_t pid = 0;  // of the last start
  std::uint32_t restarts = 0;
  std::uint32_t hangs = 0;
  bool hung = false;  // the last end was our doing, for that
  std::optional<ProcessEnd> last_end;
  std::string last_words;  // the last line it wrote before it ended by itself
};

class Supervisor {
 public:
  using Clock = std::function<Duration()>;  // monotonic

  explicit Supervisor(SupervisorConfig config, Clock clock = {});
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Starts one more child. An Error when its program cannot be executed.
  Status start(const ChildSpec& spec);

  /// Looks after the children: takes ends, kills what hangs, restarts what is due. Tells of every end through
  /// `on_end`.
  void check(const std::function<void(const ChildReport&)>& on_end = {});
  /// What becomes readable when a child ends.
  void add_descriptors(std::vector<pollfd>& descriptors) const;
  /// When the next restart is due, on the monotonic clock.
  std::optional<Duration> next_restart() const;

  /// SIGTERM to all; stop_all waits for them.
  void request_stop();
  /// SIGTERM to all, a bounded wait, SIGKILL to what still runs. Nothing runs afterwards.
  void stop_all();

  const SupervisorConfig& config() const { return config_; }
  std::vector<ChildReport> reports() const;
  bool all_running() const;
  std::filesystem::path log_file(const std::string& child) const { return config_.log_directory / (child + ".log"); }

 private:
  struct Child {
    ChildSpec spec;
    std::optional<ChildProcess> process;
    ChildReport report;
    Duration started{};
    std::uint32_t restarts_in_a_row = 0;
    Duration backoff{};
    Duration restart_at{};
    std::optional<NotifySocket> notify;
    bool ready = false;
    bool stopping = false;
    bool killed = false;
    Duration silent{};
  };

  Status launch(Child& child);
  void listen_to(Child& child, Duration since_last_check);
  void note_end(Child& child, const ProcessEnd& end);

  SupervisorConfig config_;
  Clock clock_;
  std::vector<std::unique_ptr<Child>> children_;
  std::optional<Duration> stop_requested_at_;
  std::optional<Duration> last_check_;
};

/// Waits until one of the descriptors is readable or for `timeout`.
void wait_for(std::vector<pollfd>& descriptors, Duration timeout);

}  // namespace eciton::deploy

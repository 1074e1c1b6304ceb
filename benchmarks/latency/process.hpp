// A program that takes part in a measurement: started in its network namespace, on its processor, under its policy,
// with which it is spoken to line by line. No wait is without a bound, and each ends when the run is stopped.
#pragma once

#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"
#include "core/runtime/stop_signal.hpp"

namespace eciton::bench {

/// What all threads of a program begin with.
struct Footing {
  std::string network_namespace{};  // its file; empty: ours
  int cpu = -1;                     // all on this one; -1: wherever
  int priority = 0;                 // SCHED_FIFO; 0: SCHED_OTHER
};

struct ProgramSpec {
  std::string path{};
  std::vector<std::string> arguments{};
  std::map<std::string, std::string> environment{};  // beside ours
  Footing footing{};
  bool quiet = false;  // its standard error is thrown away
};

class Process {
 public:
  /// The Error says what stood in the way: no such program, no such namespace, no right.
  static Result<Process> start(const ProgramSpec& spec);
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;
  /// Closes its input, gives it half a second, then kills it.
  ~Process();

  /// False: it is gone.
  bool say(const std::string& line);
  /// Its next line; the Error says that it ended and how, that it was silent until `deadline`, or that `stop` was
  /// set.
  Result<std::string> hear(Duration deadline, const runtime::StopFlag& stop);
  pid_t id() const { return id_; }

 private:
  Process() = default;
  std::string how_it_ended();

  std::string name_;
  pid_t id_ = -1;
  int input_ = -1;
  int output_ = -1;
  bool reaped_ = false;
  int status_ = 0;
  std::string heard_;
};

/// What is wrong with the processor and the policy of `footing` on this machine, before anything starts.
Status check(const Footing& footing);

/// What Error::message begins with when `stop` ended a wait.
inline constexpr const char* interrupted = "interrupted";

}  // namespace eciton::bench

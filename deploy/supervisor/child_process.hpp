// One child process: in a process group of its own, output in a log file, never outliving its parent.
// Used from the thread that made it, which must live as long as the child shall.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"

namespace eciton::deploy {

struct ProgramCall {
  std::vector<std::string> arguments;                              // the first one is the program's path
  std::vector<std::pair<std::string, std::string>> environment{};  // over the parent's; an empty value unsets
  std::filesystem::path log_file;                                  // appended to
  std::filesystem::path network_namespace{};                       // as "/run/netns/eciton-m1"; empty: the caller's
};

/// How a process ended: an exit status, or the signal that ended it.
struct ProcessEnd {
  int exit_status = 0;  // when signal is 0
  int signal = 0;
  std::string text() const;  // "exit status 2", "signal 9 (Killed)"
};

class ChildProcess {
 public:
  /// An Error when the program cannot be executed; otherwise it runs.
  static Result<ChildProcess> start(const ProgramCall& call);

  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  /// Kills it if it still runs.
  ~ChildProcess();

  pid_t pid() const { return pid_; }
  /// Readable when it has ended: for polls.
  int file_descriptor() const { return pidfd_; }
  /// Its end, once; nothing while it runs.
  std::optional<ProcessEnd> take_end();
  /// To its whole process group.
  void signal(int number) const;

 private:
  ChildProcess(pid_t pid, int pidfd) : pid_(pid), pidfd_(pidfd) {}

  pid_t pid_ = -1;
  int pidfd_ = -1;
};

/// The last lines of a log, oldest first; none when there is no such file.
std::vector<std::string> last_lines(const std::filesystem::path& file, std::size_t count);

}  // namespace eciton::deploy

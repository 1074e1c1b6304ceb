// Pipes, fork, and poll with a deadline.
#include "benchmarks/latency/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "core/base/wall_clock.hpp"

namespace eciton::bench {
namespace {

constexpr Duration farewell = std::chrono::milliseconds(500);

/// In the child, where nothing may allocate: errno of what failed, 0: none did.
int stand(const Footing& footing, int network_namespace) {
  if (network_namespace >= 0 && ::setns(network_namespace, CLONE_NEWNET) != 0) return errno;
  ::prctl(PR_SET_TIMERSLACK, 1UL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // ddsperf does not mind its input
  if (footing.cpu >= 0) {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(footing.cpu), &one);
    if (::sched_setaffinity(0, sizeof one, &one) != 0) return errno;
  }
  const sched_param parameters{.sched_priority = footing.priority};
  if (footing.priority > 0 && ::sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) return errno;
  return 0;
}

/// What exec takes, made before the fork.
struct Words {
  explicit Words(const ProgramSpec& spec) : arguments{spec.path} {
    arguments.insert(arguments.end(), spec.arguments.begin(), spec.arguments.end());
    for (char** each = environ; *each != nullptr; ++each) {
      const std::string entry = *each;
      if (!spec.environment.contains(entry.substr(0, entry.find('=')))) environment.push_back(entry);
    }
    for (const auto& [name, value] : spec.environment) environment.push_back(name + "=" + value);
  }
  static std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> all;
    for (std::string& word : words) all.push_back(word.data());
    all.push_back(nullptr);
    return all;
  }
  std::vector<std::string> arguments, environment;
};

[[noreturn]] void become(const ProgramSpec& spec, int network_namespace, char* const* arguments,
                         char* const* environment, int report) {
  int error = stand(spec.footing, network_namespace);
  if (error == 0) {
    ::execve(spec.path.c_str(), arguments, environment);
    error = errno;
  }
  [[maybe_unused]] const auto told = ::write(report, &error, sizeof error);
  ::_exit(127);
}

}  // namespace

Status check(const Footing& footing) {
  const pid_t probe = ::fork();
  if (probe == 0) ::_exit(stand(footing, -1));
  int status = 0;
  if (probe < 0 || ::waitpid(probe, &status, 0) != probe) return Error{"no process can be started"};
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    std::string what = footing.priority > 0 ? "SCHED_FIFO at priority " + std::to_string(footing.priority) : "";
    if (footing.cpu >= 0) what += std::string(what.empty() ? "" : ", ") + "processor " + std::to_string(footing.cpu);
    return Error{"no right to, or no such thing as, " + what + ": " + std::strerror(WEXITSTATUS(status))};
  }
  return ok();
}

Result<Process> Process::start(const ProgramSpec& spec) {
  Process process;
  process.name_ = spec.path.substr(spec.path.rfind('/') + 1);
  int space = -1;
  if (!spec.footing.network_namespace.empty()) {
    space = ::open(spec.footing.network_namespace.c_str(), O_RDONLY | O_CLOEXEC);
    if (space < 0) return Error{process.name_ + ": no network namespace " + spec.footing.network_namespace};
  }
  std::array<int, 2> input{}, output{}, report{};
  // Close-on-exec: a child that held another's input open would keep it from ending.
  if (::pipe2(input.data(), O_CLOEXEC) != 0 || ::pipe2(output.data(), O_CLOEXEC) != 0 ||
      ::pipe2(report.data(), O_CLOEXEC) != 0) {
    return Error{process.name_ + ": no pipe can be made: " + std::strerror(errno)};
  }
  Words words(spec);
  const std::vector<char*> arguments = Words::pointers(words.arguments);
  const std::vector<char*> environment = Words::pointers(words.environment);
  process.id_ = ::fork();
  if (process.id_ == 0) {
    ::dup2(input[0], STDIN_FILENO);
    ::dup2(output[1], STDOUT_FILENO);
    if (spec.quiet) ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
    become(spec, space, arguments.data(), environment.data(), report[1]);
  }
  for (const int fd : {input[0], output[1], report[1]}) ::close(fd);
  if (space >= 0) ::close(space);
  process.input_ = input[1];
  process.output_ = output[0];
  int error = process.id_ < 0 ? errno : 0;
  if (process.id_ > 0) [[maybe_unused]]
    const auto got = ::read(report[0], &error, sizeof error);
  ::close(report[0]);
  if (error != 0) return Error{spec.path + " cannot be started: " + std::strerror(error)};
  return process;
}

Process::Process(Process&& other) noexcept
    : name_(std::move(other.name_)),
      id_(std::exchange(other.id_, -1)),
      input_(std::exchange(other.input_, -1)),
      output_(std::exchange(other.output_, -1)),
      reaped_(other.reaped_),
      status_(other.status_),
      heard_(std::move(other.heard_)) {}

Process::~Process() {
  if (input_ >= 0) ::close(input_);
  if (output_ >= 0) ::close(output_);
  if (id_ <= 0 || reaped_) return;
  const Duration end = monotonic_now() + farewell;
  while (::waitpid(id_, &status_, WNOHANG) == 0) {
    if (monotonic_now() > end) ::kill(id_, SIGKILL);
    ::poll(nullptr, 0, 2);
  }
}

bool Process::say(const std::string& line) {
  const std::string text = line + "\n";
  return ::write(input_, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

std::string Process::how_it_ended() {
  // Its output closed: it is ending, or has ended.
  for (const Duration end = monotonic_now() + farewell; !reaped_ && monotonic_now() < end; ::poll(nullptr, 0, 1)) {
    reaped_ = ::waitpid(id_, &status_, WNOHANG) == id_;
  }
  if (!reaped_) return "closed its output";
  if (WIFSIGNALED(status_)) return "was ended by signal " + std::to_string(WTERMSIG(status_));
  return "ended with status " + std::to_string(WEXITSTATUS(status_));
}

Result<std::string> Process::hear(Duration deadline, const runtime::StopFlag& stop) {
  for (;;) {
    if (const std::size_t end = heard_.find('\n'); end != std::string::npos) {
      std::string line = heard_.substr(0, end);
      heard_.erase(0, end + 1);
      return line;
    }
    // What is there is heard even when the time is over: others may have used it up.
    const Duration left = std::max(deadline - monotonic_now(), Duration::zero());
    std::array<pollfd, 2> wait{{{output_, POLLIN, 0}, {stop.file_descriptor(), POLLIN, 0}}};
    const auto left_ms = std::chrono::ceil<std::chrono::milliseconds>(left).count();
    if (::poll(wait.data(), wait.size(), static_cast<int>(std::min<std::int64_t>(left_ms, 1000))) < 0) continue;
    if (wait[1].revents != 0) return Error{interrupted};
    if (wait[0].revents == 0) {
      if (left > Duration::zero()) continue;
      return Error{name_ + " did not answer in time"};
    }
    std::array<char, 65536> bytes;
    const ssize_t size = ::read(output_, bytes.data(), bytes.size());
    if (size <= 0) return Error{name_ + " " + how_it_ended()};
    heard_.append(bytes.data(), static_cast<std::size_t>(size));
  }
}

}  // namespace eciton::bench

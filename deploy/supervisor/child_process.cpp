// fork and exec with what a supervised child needs: group, death signal, log, clean descriptors and signals.
#include "deploy/supervisor/child_process.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <fstream>

extern char** environ;

namespace eciton::deploy {
namespace {

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

std::vector<std::string> child_environment(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::vector<std::string> result;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const std::string name = text.substr(0, text.find('='));
    const bool changed = std::any_of(changes.begin(), changes.end(), [&](const auto& c) { return c.first == name; });
    if (!changed) result.push_back(text);
  }
  for (const auto& [name, value] : changes) {
    if (!value.empty()) result.push_back(name + "=" + value);
  }
  return result;
}

/// In the child, between fork and exec: only what is async-signal-safe, since the parent may have threads.
[[noreturn]] void become(char* const* arguments, char* const* environment, int log, int report, pid_t parent,
                         const char* network_namespace) {
  ::setpgid(0, 0);
  // Not SIGTERM: nothing may be left behind when the supervisor itself is killed, not even what hangs.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // it died before the call above
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  for (int number = 1; number < NSIG; ++number) {
    if (number != SIGKILL && number != SIGSTOP) ::signal(number, SIG_DFL);
  }
  const int null = ::open("/dev/null", O_RDONLY);
  ::dup2(null, STDIN_FILENO);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  if (*network_namespace != '\0' && ::setns(::open(network_namespace, O_RDONLY), CLONE_NEWNET) != 0) {
    const int error = errno;
    [[maybe_unused]] const auto written = ::write(report, &error, sizeof error);
    ::_exit(127);
  }
  // Vendors' libraries open sockets without close-on-exec; a child must not keep its parent's ports.
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  ::execve(arguments[0], arguments, environment);
  const int error = errno;
  [[maybe_unused]] const auto written = ::write(report, &error, sizeof error);
  ::_exit(127);
}

}  // namespace

std::string ProcessEnd::text() const {
  if (signal == 0) return "exit status " + std::to_string(exit_status);
  return "signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
}

Result<ChildProcess> ChildProcess::start(const ProgramCall& call) {
  std::vector<std::string> arguments = call.arguments;
  std::vector<std::string> environment = child_environment(call.environment);
  const std::vector<char*> argument_pointers = pointers(arguments);
  const std::vector<char*> environment_pointers = pointers(environment);
  const std::string network_namespace = call.network_namespace;
  if (!network_namespace.empty() && ::access(network_namespace.c_str(), F_OK) != 0) {
    return Error{"network namespace " + network_namespace + " for " + call.arguments[0] + ": " +
                 std::strerror(errno)};
  }
  const int log = ::open(call.log_file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (log < 0) return Error{"log file " + call.log_file.string() + " cannot be opened: " + std::strerror(errno)};
  std::array<int, 2> report{};
  if (::pipe2(report.data(), O_CLOEXEC) != 0) {
    const int why = errno;
    ::close(log);
    return Error{call.arguments[0] + " cannot be started: " + std::strerror(why)};
  }
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  const int fork_error = errno;
  if (pid == 0)
    become(argument_pointers.data(), environment_pointers.data(), log, report[1], parent, network_namespace.c_str());
  ::close(log);
  ::close(report[1]);
  int error = pid < 0 ? fork_error : 0;
  // Closed by a successful exec, so this waits no longer than that takes.
  if (pid > 0 && ::read(report[0], &error, sizeof error) != sizeof error) error = 0;
  ::close(report[0]);
  if (error != 0) {
    if (pid > 0) ::waitpid(pid, nullptr, 0);
    return Error{"program " + call.arguments[0] + " cannot be started: " + std::strerror(error)};
  }
  ::setpgid(pid, pid);  // as the child does; whoever is first
  const auto pidfd = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
  ChildProcess child(pid, pidfd);
  if (pidfd < 0) return Error{std::string("no pid descriptor can be made: ") + std::strerror(errno)};
  return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), pidfd_(std::exchange(other.pidfd_, -1)) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(pidfd_, other.pidfd_);
  return *this;
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) {
    signal(SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  if (pidfd_ >= 0) ::close(pidfd_);
}

std::optional<ProcessEnd> ChildProcess::take_end() {
  int status = 0;
  if (pid_ <= 0 || ::waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  // What it may have started dies with it.
  ::kill(-pid_, SIGKILL);
  pid_ = -1;
  ::close(std::exchange(pidfd_, -1));
  if (WIFSIGNALED(status)) return ProcessEnd{.signal = WTERMSIG(status)};
  return ProcessEnd{.exit_status = WEXITSTATUS(status)};
}

void ChildProcess::signal(int number) const {
  if (pid_ > 0) ::kill(-pid_, number);
}

std::vector<std::string> last_lines(const std::filesystem::path& file, std::size_t count) {
  std::ifstream in(file);
  std::deque<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (line.empty()) continue;
    lines.push_back(line);
    if (lines.size() > count) lines.pop_front();
  }
  return {lines.begin(), lines.end()};
}

}  // namespace eciton::deploy

// fork, exec, and a poll over both pipes.
#include "tests/deploy/command/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>

namespace eciton::tests {
namespace {

using Clock = std::chrono::steady_clock;

/// False at the end of the pipe.
bool read_some(int fd, std::string& into) {
  std::array<char, 4096> block{};
  const ssize_t got = ::read(fd, block.data(), block.size());
  if (got > 0) into.append(block.data(), static_cast<std::size_t>(got));
  return got > 0;
}

pid_t start(const std::vector<std::string>& argv, int out, int err) {
  std::vector<char*> words;
  for (const std::string& word : argv) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  ::execv(words[0], words.data());
  ::_exit(127);
}

}  // namespace

Ended run(const std::vector<std::string>& argv, std::chrono::milliseconds limit,
          std::chrono::milliseconds interrupt_after) {
  std::array<int, 2> out{};
  std::array<int, 2> err{};
  if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0) return {};
  const pid_t pid = start(argv, out[1], err[1]);
  ::close(out[1]);
  ::close(err[1]);
  const Clock::time_point started = Clock::now();
  bool interrupted = interrupt_after.count() == 0;
  bool killed = false;
  Ended ended;
  std::array<pollfd, 2> fds{pollfd{out[0], POLLIN, 0}, pollfd{err[0], POLLIN, 0}};
  while (fds[0].fd >= 0 || fds[1].fd >= 0) {
    ::poll(fds.data(), fds.size(), 20);
    const auto elapsed = Clock::now() - started;
    if (!interrupted && elapsed > interrupt_after) {
      ::kill(pid, SIGINT);
      interrupted = true;
    }
    if (!killed && elapsed > limit) {
      ::kill(pid, SIGKILL);
      killed = true;
    }
    if (fds[0].revents != 0 && !read_some(fds[0].fd, ended.out)) fds[0].fd = -1;
    if (fds[1].revents != 0 && !read_some(fds[1].fd, ended.err)) fds[1].fd = -1;
  }
  ::close(out[0]);
  ::close(err[0]);
  int status = 0;
  ::waitpid(pid, &status, 0);
  ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ended;
}

}  // namespace eciton::tests

// A pipe carries the child's first words: '+', or the reason.
#include "deploy/command/detach.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/base/result.hpp"

namespace eciton::deploy {

Detached Detached::fork() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw BadInput{{std::string("no pipe can be made: ") + std::strerror(errno)}};
  std::fflush(nullptr);
  Detached detached;
  detached.child_ = ::fork();
  if (detached.child_ < 0) throw BadInput{{std::string("no process can be made: ") + std::strerror(errno)}};
  const bool parent = detached.child_ > 0;
  detached.pipe_ = ends[parent ? 0 : 1];
  ::close(ends[parent ? 1 : 0]);
  if (!parent) ::setsid();
  return detached;
}

Detached::Detached(Detached&& other) noexcept
    : child_(std::exchange(other.child_, 0)), pipe_(std::exchange(other.pipe_, -1)) {}

Detached::~Detached() {
  if (pipe_ >= 0) ::close(pipe_);
}

int Detached::wait_for_start() {
  std::string words;
  std::array<char, 256> block{};
  for (ssize_t got = 0; (got = ::read(pipe_, block.data(), block.size())) > 0 || (got < 0 && errno == EINTR);) {
    if (got > 0) words.append(block.data(), static_cast<std::size_t>(got));
  }
  if (words == "+") return 0;
  ::waitpid(child_, nullptr, 0);
  throw BadInput{{words.empty() ? "the process in the background ended before it had started" : words}};
}

void Detached::report_started() {
  if (pipe_ < 0) return;
  std::fflush(nullptr);
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(null, fd);
  ::close(null);
  [[maybe_unused]] const auto written = ::write(pipe_, "+", 1);
  ::close(std::exchange(pipe_, -1));
}

void Detached::report_failure(const std::string& message) {
  if (pipe_ < 0) return;
  [[maybe_unused]] const auto written = ::write(pipe_, message.data(), message.size());
  ::close(std::exchange(pipe_, -1));
  std::_Exit(2);  // the parent says it
}

}  // namespace eciton::deploy

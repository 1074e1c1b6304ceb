// A peer as a process of its own, ended by closing its input; what it prints is kept.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace eciton::native_peers {

/// Programs of the build lie side by side.
inline std::string beside_this_program(const std::string& name) {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name).string();
}

class ChildProcess {
 public:
  explicit ChildProcess(std::vector<std::string> command) {
    std::array<int, 2> input{};
    std::array<int, 2> output{};
    // Close-on-exec: a child that held another's input open would keep it from ending.
    if (pipe2(input.data(), O_CLOEXEC) != 0 || pipe2(output.data(), O_CLOEXEC) != 0) return;
    std::vector<char*> arguments;
    for (std::string& argument : command) arguments.push_back(argument.data());
    arguments.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGTERM);  // a test that is killed leaves nobody behind
      dup2(input[0], STDIN_FILENO);
      dup2(output[1], STDOUT_FILENO);
      execv(arguments[0], arguments.data());
      _exit(127);
    }
    close(input[0]);
    close(output[1]);
    input_ = input[1];
    output_ = output[0];
  }
  ~ChildProcess() {
    if (!ended_) {
      close_input();
      if (!wait_until_end(std::chrono::seconds(3))) kill(pid_, SIGKILL);
      wait_until_end(std::chrono::seconds(10));
    }
    close(output_);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void close_input() {
    if (input_ >= 0) close(input_);
    input_ = -1;
  }
  pid_t pid() const { return pid_; }
  void send(int signal) {
    if (running()) kill(pid_, signal);
  }
  bool running() {
    read_output();
    if (!ended_ && waitpid(pid_, &status_, WNOHANG) == pid_) ended_ = true;
    return !ended_;
  }
  bool wait_until_end(std::chrono::milliseconds limit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (running()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    read_output();
    return true;
  }
  /// Of a process that ended; -1 if a signal ended it.
  int exit_status() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1; }
  const std::string& output() const { return text_; }

 private:
  void read_output() {
    std::array<char, 4096> buffer;
    pollfd descriptor{output_, POLLIN, 0};
    while (poll(&descriptor, 1, 0) > 0) {
      const ssize_t size = read(output_, buffer.data(), buffer.size());
      if (size <= 0) return;
      text_.append(buffer.data(), static_cast<std::size_t>(size));
    }
  }

  pid_t pid_ = -1;
  int input_ = -1;
  int output_ = -1;
  int status_ = 0;
  bool ended_ = false;
  std::string text_;
};

}  // namespace eciton::native_peers

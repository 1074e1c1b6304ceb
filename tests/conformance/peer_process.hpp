// A conformance_peer as a process of its own, killed without notice.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <string>

#include "tests/conformance/ring.hpp"

namespace eciton::bus::conformance {

class PeerProcess {
 public:
  PeerProcess(const std::string& vendor, int incarnation, int period_us = 10'000) {
    std::string words[] = {ECITON_CONFORMANCE_PEER, vendor, std::to_string(test_domain()),
                           std::to_string(incarnation), std::to_string(period_us)};
    char* arguments[] = {words[0].data(), words[1].data(), words[2].data(),
                         words[3].data(), words[4].data(), nullptr};
    EXPECT_EQ(::posix_spawn(&pid_, words[0].c_str(), nullptr, nullptr, arguments, environ), 0) << words[0];
  }
  ~PeerProcess() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;

 private:
  pid_t pid_ = 0;
};

}  // namespace eciton::bus::conformance

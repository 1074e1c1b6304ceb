// Runs a program as a shell would, and keeps what it printed and how it ended.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace eciton::tests {

struct Ended {
  int status = -1;  // exit status; 128 + signal when one ended it
  std::string out;
  std::string err;
};

/// `argv[0]` is the program. Killed, with status 137, when it has not ended within the limit. With
/// `interrupt_after`, SIGINT is sent then, as Ctrl-C does.
Ended run(const std::vector<std::string>& argv, std::chrono::milliseconds limit = std::chrono::seconds(30),
          std::chrono::milliseconds interrupt_after = {});

}  // namespace eciton::tests

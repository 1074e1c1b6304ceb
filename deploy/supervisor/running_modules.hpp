// What runs on this host, as its launches wrote it down in their runtime directories.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "deploy/supervisor/runtime_directory.hpp"

namespace eciton::deploy {

inline constexpr const char* state_file_name = "state.json";
inline constexpr const char* faults_name = "faults";  // the directory of what was known and done before each fault

struct RunningProcess {
  std::string name;
  std::string vendor;
  pid_t pid = 0;  // 0: it does not run at the moment
  std::uint32_t restarts = 0;
  std::uint32_t hangs = 0;  // of those restarts, after a hang
  std::string last_end{};   // "signal 9 (Killed)"; empty: it never ended
};

struct RunningModule {
  std::string name;
  pid_t holder = 0;
  std::uint32_t module_id = 0;  // 0: a world or a demo
  std::uint32_t domain = 0;
  std::string network_interface;
  std::string network_namespace{};  // of that interface; empty: this host's own
  std::vector<RunningProcess> processes;
  std::filesystem::path faults{};  // directory of its fault records; empty: not known
};

std::string to_text(const RunningModule& module);
/// Those whose holder lives, by name; what cannot be read is left out.
std::vector<RunningModule> running_modules(const std::filesystem::path& root = runtime_root());

}  // namespace eciton::deploy

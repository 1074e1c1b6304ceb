// What a chaos run must not leave behind: processes, shared memory; and memory that grows.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "deploy/supervisor/launch_loop.hpp"

namespace eciton::deploy {

/// A small file system of its own in memory, where a run's processes have their runtime directories: what fills it
/// up fills nothing else. Gone with this.
class SmallDisk {
 public:
  /// Throws BadInput where it may not be mounted. While it lives ECITON_RUNTIME_DIR names it.
  explicit SmallDisk(std::filesystem::path directory);
  ~SmallDisk();
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  const std::filesystem::path& path() const { return directory_; }
  /// Processes that were started with it, this one left out.
  std::vector<pid_t> users() const;

 private:
  std::filesystem::path directory_;
};

/// By name, what lies in /dev/shm.
std::set<std::string> shared_memory_files();

/// How much memory the same processes hold, later.
class MemoryGrowth {
 public:
  void begin(const Launches& launches);
  struct Most {
    double share = 0;  // of what it held at the beginning
    std::string process{};
  };
  /// Among those that have run all the time.
  Most most(const Launches& launches) const;

 private:
  std::map<pid_t, double> begin_bytes_;
};

}  // namespace eciton::deploy

// tmpfs, /proc and /dev/shm.
#include "deploy/command/chaos_leaks.hpp"

#include <sys/mount.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

namespace eciton::deploy {
namespace {

namespace fs = std::filesystem;
constexpr const char* disk_size = "size=64m";
constexpr const char* variable = "ECITON_RUNTIME_DIR";

/// 0: it is gone.
double resident_bytes(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
  double size = 0, resident = 0;
  if (!(file >> size >> resident)) return 0;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

template <class Visit>
void for_each_running(const Launches& launches, Visit&& visit) {
  for (const auto& launch : launches) {
    for (const ChildReport& report : launch->supervisor().reports()) {
      if (report.state == ChildState::running) visit(*launch, report);
    }
  }
}

}  // namespace

SmallDisk::SmallDisk(fs::path directory) : directory_(std::move(directory)) {
  std::error_code error;
  fs::create_directories(directory_, error);
  if (error || ::mount("eciton-chaos", directory_.c_str(), "tmpfs", MS_NOSUID | MS_NODEV, disk_size) != 0) {
    throw BadInput{{"a small disk cannot be mounted at " + directory_.string() + ": " +
                    (error ? error.message() : std::strerror(errno)) + "; run as root, or with CAP_SYS_ADMIN"}};
  }
  ::setenv(variable, directory_.c_str(), 1);
}

SmallDisk::~SmallDisk() {
  ::unsetenv(variable);
  ::umount2(directory_.c_str(), MNT_DETACH);
  std::error_code ignored;
  fs::remove(directory_, ignored);
}

std::vector<pid_t> SmallDisk::users() const {
  std::vector<pid_t> found;
  const std::string wanted = std::string(variable) + "=" + directory_.string();
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/proc", ignored)) {
    const pid_t pid = std::atoi(entry.path().filename().c_str());
    if (pid <= 1 || pid == ::getpid()) continue;
    std::ifstream file(entry.path() / "environ", std::ios::binary);
    const std::string environment{std::istreambuf_iterator<char>(file), {}};
    if (environment.find(wanted) != std::string::npos) found.push_back(pid);
  }
  return found;
}

std::set<std::string> shared_memory_files() {
  std::set<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev/shm", ignored)) names.insert(entry.path().filename());
  return names;
}

void MemoryGrowth::begin(const Launches& launches) {
  begin_bytes_.clear();
  for_each_running(launches, [&](const Launch&, const ChildReport& report) {
    begin_bytes_[report.pid] = resident_bytes(report.pid);
  });
}

MemoryGrowth::Most MemoryGrowth::most(const Launches& launches) const {
  Most most;
  for_each_running(launches, [&](const Launch& launch, const ChildReport& report) {
    const auto begin = begin_bytes_.find(report.pid);
    const double now = resident_bytes(report.pid);
    if (begin == begin_bytes_.end() || begin->second <= 0 || now <= 0) return;
    const double share = now / begin->second - 1;
    if (most.process.empty() || share > most.share) most = {share, launch.plan().name + "/" + report.name};
  });
  return most;
}

}  // namespace eciton::deploy

// Locks are flock(2) on a file in the directory, so the kernel lets go of them when a process dies.
#include "deploy/supervisor/runtime_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <utility>

namespace eciton::deploy {
namespace {

namespace fs = std::filesystem;
constexpr const char* lock_name = "lock";
constexpr const char* stop_name = "stop";

/// A directory in /tmp that someone else made could be a trap.
Status make_private_root(const fs::path& root) {
  std::error_code failed;
  fs::create_directories(root.parent_path(), failed);
  if (::mkdir(root.c_str(), 0700) != 0 && errno != EEXIST) {
    return Error{"runtime directory " + root.string() + " cannot be made: " + std::strerror(errno) +
                 "; set ECITON_RUNTIME_DIR to a directory of yours"};
  }
  struct stat info {};
  if (::lstat(root.c_str(), &info) != 0)
    return Error{"runtime directory " + root.string() + ": " + std::strerror(errno)};
  if (!S_ISDIR(info.st_mode) || info.st_uid != ::geteuid()) {
    return Error{"runtime directory " + root.string() +
                 " is not a directory of yours; set ECITON_RUNTIME_DIR to one that is"};
  }
  return ok();
}

pid_t holder_of(const fs::path& directory) {
  pid_t pid = 0;
  std::ifstream(directory / lock_name) >> pid;
  return pid;
}

bool same_file(int descriptor, const fs::path& path) {
  struct stat open_file {
  }, named{};
  return ::fstat(descriptor, &open_file) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open_file.st_ino == named.st_ino && open_file.st_dev == named.st_dev;
}

void remove_all_but_lock(const fs::path& directory) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(directory, failed)) {
    if (entry.path().filename() != lock_name) fs::remove_all(entry.path(), failed);
  }
}

}  // namespace

fs::path runtime_root() {
  if (const char* own = std::getenv("ECITON_RUNTIME_DIR"); own != nullptr && *own != '\0') return fs::absolute(own);
  if (::geteuid() == 0) return "/run/eciton";
  if (const char* session = std::getenv("XDG_RUNTIME_DIR"); session != nullptr && *session != '\0') {
    return fs::path(session) / "eciton";
  }
  return "/tmp/eciton-" + std::to_string(::geteuid());
}

Result<RuntimeDirectory> RuntimeDirectory::claim(const std::string& name, const fs::path& root) {
  const fs::path path = root / name;
  // Again when the holder before removed the directory between our opening and our locking.
  for (int attempt = 0; attempt < 20; ++attempt) {
    if (const Status made = make_private_root(root); !made) return made.error();
    if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) {
      if (errno == ENOENT) continue;
      return Error{"runtime directory " + path.string() + " cannot be made: " + std::strerror(errno)};
    }
    const int lock = ::open((path / lock_name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (lock < 0) {
      if (errno == ENOENT) continue;
      return Error{"lock file " + (path / lock_name).string() + " cannot be opened: " + std::strerror(errno)};
    }
    if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
      ::close(lock);
      return Error{name + " is already running: process " + std::to_string(holder_of(path)) + " holds " +
                   path.string()};
    }
    if (!same_file(lock, path / lock_name)) {
      ::close(lock);
      continue;
    }
    RuntimeDirectory directory(name, path, lock);
    directory.note_holder();
    remove_all_but_lock(path);
    return directory;
  }
  return Error{"runtime directory " + path.string() + " keeps being removed by another process"};
}

RuntimeDirectory::RuntimeDirectory(RuntimeDirectory&& other) noexcept
    : name_(std::move(other.name_)), path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}

RuntimeDirectory& RuntimeDirectory::operator=(RuntimeDirectory&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(path_, other.path_);
  std::swap(lock_, other.lock_);
  return *this;
}

RuntimeDirectory::~RuntimeDirectory() {
  if (lock_ < 0) return;
  std::error_code failed;
  fs::remove_all(path_, failed);
  ::close(lock_);
  ::rmdir(path_.parent_path().c_str());  // fails while others are there
}

bool RuntimeDirectory::stop_requested() const { return ::access((path_ / stop_name).c_str(), F_OK) == 0; }

void RuntimeDirectory::note_holder() const {
  const std::string pid = std::to_string(::getpid()) + "\n";
  if (::ftruncate(lock_, 0) == 0) [[maybe_unused]]
    const auto written = ::pwrite(lock_, pid.data(), pid.size(), 0);
}

bool is_held(const fs::path& directory) {
  const int lock = ::open((directory / lock_name).c_str(), O_RDONLY | O_CLOEXEC);
  if (lock < 0) return false;
  const bool free = ::flock(lock, LOCK_SH | LOCK_NB) == 0;
  ::close(lock);
  return !free;
}

std::vector<HeldDirectory> held_directories(const fs::path& root) {
  std::vector<HeldDirectory> held;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(root, failed)) {
    if (!is_held(entry.path())) continue;
    held.push_back({entry.path().filename().string(), entry.path(), holder_of(entry.path())});
  }
  std::sort(held.begin(), held.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return held;
}

Status request_stop(const HeldDirectory& directory) {
  const fs::path file = directory.path / stop_name;
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) return Error{"stop request " + file.string() + " cannot be written: " + std::strerror(errno)};
  ::close(descriptor);
  return ok();
}

}  // namespace eciton::deploy

// unshare, bind mounts and setns; what ends up in /run/netns is what `ip netns add` would put there.
#include "deploy/net/hosts.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

#include "core/base/contract.hpp"

namespace eciton::net {
namespace {

namespace fs = std::filesystem;
const fs::path namespaces_directory = "/run/netns";
constexpr const char* own_namespace = "/proc/thread-self/ns/net";
constexpr int end_patience_ms = 2000;

Error failed(const std::string& what, int why) { return Error{what + ": " + std::strerror(why)}; }

/// Mounts made in it are seen wherever it is seen, as iproute2 has it.
Status share_directory() {
  std::error_code ignored;
  fs::create_directories(namespaces_directory, ignored);
  const char* path = namespaces_directory.c_str();
  if (::mount("", path, "none", MS_SHARED | MS_REC, nullptr) == 0) return ok();
  if (errno != EINVAL || ::mount(path, path, "none", MS_BIND | MS_REC, nullptr) != 0 ||
      ::mount("", path, "none", MS_SHARED | MS_REC, nullptr) != 0) {
    return failed("directory " + namespaces_directory.string() + " cannot be shared between mount namespaces", errno);
  }
  return ok();
}

Status try_rights() {
  if (::unshare(CLONE_NEWNET) != 0)
    return failed("network namespaces cannot be made here; run as root, or with CAP_SYS_ADMIN and CAP_NET_ADMIN",
                  errno);
  const int tun = ::open("/dev/net/tun", O_RDWR | O_CLOEXEC);
  if (tun < 0)
    return failed("/dev/net/tun cannot be opened; run as root, where the kernel and the container offer TAP devices",
                  errno);
  ifreq request{};
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  std::strncpy(request.ifr_name, radio_interface, IFNAMSIZ - 1);
  const int error = ::ioctl(tun, TUNSETIFF, &request) == 0 ? 0 : errno;
  ::close(tun);
  if (error != 0) return failed("TAP devices cannot be made here; run as root, or with CAP_NET_ADMIN", error);
  if (::access("/run", W_OK) != 0) return failed("/run is not writable, where namespaces get their names", errno);
  return ok();
}

struct NamespaceId {
  dev_t device;
  ino_t inode;
  bool operator==(const NamespaceId&) const = default;
};

std::vector<NamespaceId> ids_of(const std::vector<fs::path>& files) {
  std::vector<NamespaceId> ids;
  for (const fs::path& file : files) {
    struct stat info {};
    if (::stat(file.c_str(), &info) == 0) ids.push_back({info.st_dev, info.st_ino});
  }
  return ids;
}

}  // namespace

Status check_name(const std::string& net) {
  const bool plain = !net.empty() && net.size() <= 16 && std::all_of(net.begin(), net.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
  if (plain && net.front() != '-') return ok();
  return Error{"'" + net + "' is no name for a net; expected up to 16 lower-case letters, digits and dashes"};
}

std::string host_name(std::uint32_t index) {
  return index == operator_host ? "operator" : "m" + std::to_string(index);
}

std::string host_address(std::uint32_t index) {
  return "10.99.0." + std::to_string(index == operator_host ? 254 : index);
}

std::string moved_address(std::uint32_t index) { return "10.99.0." + std::to_string(100 + index); }

fs::path host_namespace(const std::string& net, std::uint32_t index) {
  return namespaces_directory / (net + "-" + host_name(index));
}

InNamespace::InNamespace(const fs::path& file) {
  if (file.empty()) return;
  const int there = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (there < 0) throw BadInput{failed("network namespace " + file.string() + " cannot be opened", errno)};
  original_ = ::open(own_namespace, O_RDONLY | O_CLOEXEC);
  const bool entered = original_ >= 0 && ::setns(there, CLONE_NEWNET) == 0;
  const int why = errno;
  ::close(there);
  if (entered) return;
  if (original_ >= 0) ::close(std::exchange(original_, -1));
  throw BadInput{failed("network namespace " + file.string() + " cannot be entered", why)};
}

InNamespace::~InNamespace() {
  if (original_ < 0) return;
  // A thread that is not where it believes to be would talk to the wrong network.
  if (::setns(original_, CLONE_NEWNET) != 0) std::abort();
  ::close(original_);
}

Status enter_host(const std::string& net, std::uint32_t index) {
  const fs::path file = host_namespace(net, index);
  const int there = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (there < 0) return failed("host " + host_name(index) + " of net " + net + ": " + file.string(), errno);
  const int error = ::setns(there, CLONE_NEWNET) == 0 ? 0 : errno;
  ::close(there);
  if (error != 0) return failed("host " + host_name(index) + " of net " + net + " cannot be entered", error);
  return ok();
}

/// Tried by a thread of its own, whose namespace goes when it ends.
Status check_rights() {
  Status status = ok();
  std::thread([&] { status = try_rights(); }).join();
  return status;
}

Status make_namespace(const fs::path& file) {
  if (const Status shared = share_directory(); !shared) return shared;
  const int fd = ::open(file.c_str(), O_RDONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0);
  if (fd < 0) {
    if (errno == EEXIST)
      return Error{
          "network namespace " + file.filename().string() +
          " is there already and is not ours; give the net another --name, or remove it with 'ip netns del " +
          file.filename().string() + "'"};
    return failed("network namespace " + file.string() + " cannot be made", errno);
  }
  ::close(fd);
  int error = 0;
  std::thread([&] {
    if (::unshare(CLONE_NEWNET) != 0 || ::mount(own_namespace, file.c_str(), "none", MS_BIND, nullptr) != 0) {
      error = errno;
    }
  }).join();
  if (error == 0) return ok();
  ::unlink(file.c_str());
  return failed("network namespace " + file.string() + " cannot be made", error);
}

void remove_namespace(const fs::path& file) {
  ::umount2(file.c_str(), MNT_DETACH);
  ::unlink(file.c_str());
}

std::vector<pid_t> processes_in(const std::vector<fs::path>& namespaces) {
  const std::vector<NamespaceId> ids = ids_of(namespaces);
  std::vector<pid_t> found;
  if (ids.empty()) return found;
  std::error_code failed_to_list;
  for (const auto& entry : fs::directory_iterator("/proc", failed_to_list)) {
    const pid_t pid = std::atoi(entry.path().filename().c_str());
    if (pid <= 1 || pid == ::getpid()) continue;
    const std::vector<NamespaceId> its = ids_of({entry.path() / "ns" / "net"});
    if (!its.empty() && std::find(ids.begin(), ids.end(), its[0]) != ids.end()) found.push_back(pid);
  }
  return found;
}

void end_processes_in(const std::vector<fs::path>& namespaces) {
  for (const pid_t pid : processes_in(namespaces)) ::kill(pid, SIGTERM);
  for (int waited_ms = 0; waited_ms < end_patience_ms; waited_ms += 20) {
    if (processes_in(namespaces).empty()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (const pid_t pid : processes_in(namespaces)) ::kill(pid, SIGKILL);
}

}  // namespace eciton::net

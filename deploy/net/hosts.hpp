// Hosts as network namespaces: how they are called, how a thread or a process enters one, and how they are made and
// removed. They are named as iproute2 does it, so that `ip netns exec eciton-m1 …` works as well.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.hpp"

namespace eciton::net {

inline constexpr const char* default_name = "eciton";
inline constexpr std::uint32_t modules_max = 90;
/// The host of people and measuring programs; modules have their ids from 1 on.
inline constexpr std::uint32_t operator_host = 0;
/// Of every host, towards the radio.
inline constexpr const char* radio_interface = "eth0";

/// Lower-case letters, digits and dashes, at most 16.
Status check_name(const std::string& net);
/// "operator", "m1", "m2", …
std::string host_name(std::uint32_t index);
/// On the radio; the same in every net, which do not hear each other.
std::string host_address(std::uint32_t index);
/// That a module's host has after it moved: what a new lease of its access point would give it.
std::string moved_address(std::uint32_t index);
/// The file that stands for the namespace: "/run/netns/eciton-m1".
std::filesystem::path host_namespace(const std::string& net, std::uint32_t index);

/// The calling thread is in that namespace as long as this lives: sockets and threads it makes belong there, and
/// stay there. Throws BadInput when it cannot be entered. An empty path: nothing is done.
class InNamespace {
 public:
  explicit InNamespace(const std::filesystem::path& file);
  ~InNamespace();
  InNamespace(const InNamespace&) = delete;
  InNamespace& operator=(const InNamespace&) = delete;

 private:
  int original_ = -1;
};

/// Moves the calling thread, and what it makes later, into a host for good.
Status enter_host(const std::string& net, std::uint32_t index);

// Below: for whoever brings a net up or takes it down.

/// Whether this process may make namespaces and TAP devices; the Error says which right is missing.
Status check_rights();
/// An Error when it is there already.
Status make_namespace(const std::filesystem::path& file);
/// Nothing happens when it is not there.
void remove_namespace(const std::filesystem::path& file);
/// Other processes in any of these namespaces.
std::vector<pid_t> processes_in(const std::vector<std::filesystem::path>& namespaces);
/// Asks them to end, and kills what has not ended after a while.
void end_processes_in(const std::vector<std::filesystem::path>& namespaces);

}  // namespace eciton::net

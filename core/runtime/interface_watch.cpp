// getifaddrs, again and again: what netlink would tell sooner is not worth its code.
#include "core/runtime/interface_watch.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>

#include <array>

#include "core/base/log.hpp"

namespace eciton::runtime {

std::optional<std::string> address_of(const std::string& network_interface) {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return std::nullopt;
  std::optional<std::string> found;
  for (const ifaddrs* one = all; one != nullptr && !found; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET || network_interface != one->ifa_name)
      continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr) found = text.data();
  }
  ::freeifaddrs(all);
  return found;
}

InterfaceWatch::InterfaceWatch(std::string network_interface, StopFlag& stop, Duration interval)
    : interface_(std::move(network_interface)),
      stop_(stop),
      interval_(interval),
      first_(address_of(interface_)),
      thread_([this] { watch(); }) {}

InterfaceWatch::~InterfaceWatch() {
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

void InterfaceWatch::watch() {
  bool lost = !first_;
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, interval_, [this] { return ending_; })) {
    const auto now = address_of(interface_);
    if (!now && !lost) spdlog::warn("{} has no address any more", interface_);
    lost = lost || !now;
    if (!now || (!lost && now == first_)) continue;
    spdlog::warn("{} has address {}; it was {}: starting anew", interface_, *now,
                 first_.value_or("without one at the start"));
    stop_.request();
    return;
  }
}

}  // namespace eciton::runtime

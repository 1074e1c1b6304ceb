// Notices that a network interface has another address than when a participant was made on it: vendors announce the
// one they found at their start for ever.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/base/time.hpp"
#include "core/runtime/stop_signal.hpp"

namespace eciton::runtime {

/// The interface's first IPv4 address, "10.99.0.1"; nothing while it has none.
std::optional<std::string> address_of(const std::string& network_interface);

/// Looks several times a second, from a thread of its own, in the network namespace of its maker.
class InterfaceWatch {
 public:
  /// Requests `stop` once the interface has an address again and it is not the first one's, or it had none meanwhile:
  /// the process is to be started anew.
  InterfaceWatch(std::string network_interface, StopFlag& stop, Duration interval = std::chrono::milliseconds(200));
  ~InterfaceWatch();
  InterfaceWatch(const InterfaceWatch&) = delete;
  InterfaceWatch& operator=(const InterfaceWatch&) = delete;

 private:
  void watch();

  std::string interface_;
  StopFlag& stop_;
  Duration interval_;
  std::optional<std::string> first_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace eciton::runtime

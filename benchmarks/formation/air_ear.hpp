// Listens at the radio interfaces of several hosts to what each of them sends.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

#include "benchmarks/formation/rtps_meter.hpp"
#include "core/runtime/stop_signal.hpp"
#include "deploy/net/net.hpp"

namespace eciton::bench {

class AirEar {
 public:
  /// At the first `hosts` modules' hosts. Throws BadInput without the right to listen.
  AirEar(const net::OwnedNet& net, std::uint32_t hosts);
  ~AirEar();
  AirEar(const AirEar&) = delete;
  AirEar& operator=(const AirEar&) = delete;

  void restart();
  /// One meter per host, as they stand.
  std::vector<RtpsMeter> meters() const;
  /// Frames that came faster than they were counted.
  std::uint64_t missed();

 private:
  void run();

  std::vector<int> sockets_;
  mutable std::mutex mutex_;
  std::vector<RtpsMeter> meters_;
  std::uint64_t missed_ = 0;
  runtime::StopFlag stop_;
  std::thread thread_;
};

}  // namespace eciton::bench

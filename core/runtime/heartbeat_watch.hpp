// For a service that watches others of its module: their heartbeats in, faults out. The radio watches them all; since
// it must not be the only one that could die unseen, docking watches the radio.
#pragma once

#include "core/bus/participant.hpp"
#include "core/runtime/service_watch.hpp"
#include "idl/topics.hpp"

namespace eciton::runtime {

/// Real-time safe; one thread. Every step: begin, hear what came, tell.
class HeartbeatWatch {
 public:
  /// `watcher`: the service that watches, which is told apart from those it watches.
  HeartbeatWatch(std::uint32_t module_id, std::string_view watcher, Duration period)
      : module_id_(module_id), watcher_(watcher), watch_(period) {}

  void begin(TimePoint now) noexcept;
  void hear(const msg::Heartbeat& heartbeat) noexcept;
  /// Writes a fault for each service that fell silent, and for each that is back.
  void tell(bus::Writer<msg::Fault>& faults) noexcept;

  std::uint8_t silent_services() const noexcept { return static_cast<std::uint8_t>(watch_.silent_services()); }
  std::uint64_t silences() const noexcept { return watch_.silences(); }

 private:
  std::uint32_t module_id_;
  std::string_view watcher_;
  ServiceWatch watch_;
  TimePoint now_{};
};

}  // namespace eciton::runtime

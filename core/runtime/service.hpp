// A service: inputs, outputs and a step. It is given the time and never asks for it, so that the same
// code runs on the wall clock, in lockstep and in simulation.
#pragma once

#include <optional>
#include <string_view>

#include "core/base/time.hpp"
#include "core/bus/endpoint.hpp"
#include "idl/fleet.hpp"

namespace eciton::runtime {

/// The order in which services step when several are due at one time.
enum class Phase { sense, estimate, coordinate, control, act };

/// When a service steps: at its own period, or when a reader has a sample.
struct Schedule {
  Duration period{};                   // periodic: 0 < period
  bus::ReaderCore* trigger = nullptr;  // triggered: step when it has a sample ...
  Duration at_most{};                  // ... at the latest this long after the last step; on the wall clock
                                       // a quarter longer after one that had a sample
  Phase phase = Phase::coordinate;
};

inline Schedule every(Duration period, Phase phase) { return {.period = period, .phase = phase}; }

/// `reader` is a member of the service, as in on(imu_, 5ms, Phase::estimate).
template <class Reader>
Schedule on(Reader& reader, Duration at_most, Phase phase) {
  return {.trigger = &reader.trigger(), .at_most = at_most, .phase = phase};
}

class Service {
 public:
  virtual ~Service() = default;
  virtual std::string_view name() const = 0;
  virtual Schedule schedule() = 0;

  /// Takes inputs, computes, writes outputs. Real-time safe: no allocation, lock, wait or log.
  virtual void step(TimePoint now) noexcept = 0;

  /// Adds what only this service knows to its heartbeat; called between steps.
  virtual void describe(msg::Heartbeat&) const noexcept {}
};

}  // namespace eciton::runtime

// A service: inputs, outputs and a step. It is given the time and never asks for it, so that the same
// code runs on the wall clock, in lockstep and in simulation.
#pragma once

#include <optional>
#include <string_view>

#include "core/base/time.hpp"
#include "core/bus/endpoint.hpp"
#include "core/runtime/service_state.hpp"
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

/// A checkpoint older than this when the service steps again describes a flight that is over: as long as the
/// hardware host holds a chain's hover.
inline constexpr Duration resume_within = std::chrono::seconds(2);

class Service {
 public:
  virtual ~Service() = default;
  virtual std::string_view name() const = 0;
  virtual Schedule schedule() = 0;

  /// Takes inputs, computes, writes outputs. Real-time safe: no allocation, lock, wait or log.
  virtual void step(TimePoint now) noexcept = 0;

  /// Adds what only this service knows to its heartbeat; called between steps.
  virtual void describe(msg::Heartbeat&) const noexcept {}

  /// The meaning of what it keeps for the case that its process dies; 0: nothing. Another version is not read.
  virtual std::uint32_t state_version() const noexcept { return 0; }
  /// Between steps; always the same number of bytes. Real-time safe.
  virtual void save_state(StateWriter&) const noexcept {}
  /// Before its first step: what the process that died had saved last.
  virtual void load_state(StateReader&) noexcept {}
};

}  // namespace eciton::runtime

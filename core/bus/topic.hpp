// A topic: a name bound to a type, with the class of service, the scope and the times that hold for it.
// The topics of Eciton are listed in idl/topics.hpp, the only place that creates them.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/time.hpp"
#include "core/bus/type_traits.hpp"

namespace eciton::bus {

/// Mapped once per vendor; see docs/architecture.md.
enum class QosClass : std::uint8_t {
  sensor,   // best effort, keep last 1 per key, volatile
  command,  // reliable, keep last 1 per key, volatile
  state,    // reliable, keep last 1 per key, transient local
  event     // reliable, keep last 64, transient local
};

/// module: stays on the module's own ring. swarm: the radio carries it to the others.
enum class Scope : std::uint8_t { module, swarm };

template <Message T>
struct Topic {
  using Type = T;
  std::string_view name;
  QosClass qos;
  Scope scope;
  Duration deadline{};  // a reader is overdue when the newest sample is older; 0: none
  Duration lifespan{};  // an older sample is not delivered; 0: it keeps
};

constexpr std::string_view to_string(QosClass qos) {
  constexpr std::string_view names[] = {"sensor", "command", "state", "event"};
  return names[static_cast<int>(qos)];
}
constexpr std::string_view to_string(Scope scope) { return scope == Scope::swarm ? "swarm" : "module"; }

}  // namespace eciton::bus

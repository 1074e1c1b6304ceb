// What happens to the modules of a faulty world, as data: drawn from a seed, replayed exactly, and shrunk when it
// makes a promise break. Taking an event out changes nothing about the others, nor about the radio's luck.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/time.hpp"

namespace eciton::chain::test {

enum class EventKind {
  dock,          // port of a with the fitting port of b, if both are free, live and in reach
  undock,        // whatever is at the port of a
  crash,         // of a
  restart,       // of a; flag: its checkpoint is lost
  split,         // modules whose bit in b is set hear only each other
  heal,          //
  mute,          // the announcements of a are lost for a while, its claims are not
  claim_falsely  // the latch of a claims for a while to hold a port of b that is elsewhere
};

struct Event {
  Duration at{};
  EventKind kind{};
  int a = 0, port = 0, b = 0;
  Duration span{}, other_span{};  // how long it lasts; of a docking or undocking: until each latch reports it
  bool flag = false;

  bool operator==(const Event&) const = default;
};
std::string to_text(const Event& event);

enum class Airframe { chain, lattice };

struct Schedule {
  std::uint64_t seed = 1;  // of the radio and the clocks, too
  Airframe airframe = Airframe::chain;
  int modules = 2;
  double loss = 0;
  bool clocks_known = true;  // to 2 ms; else taken for equal while they are up to 4 s apart
  Duration faulty_for = 8s;
  std::vector<Event> events;  // by time

  bool operator==(const Schedule&) const = default;
};
Schedule draw_schedule(std::uint64_t seed, Airframe airframe);
std::string to_text(const Schedule& schedule);

/// The least schedule found that still `fails`, by leaving out ever smaller groups of events and, where that does,
/// modules, loss and time.
Schedule shrink(Schedule schedule, const std::function<bool(const Schedule&)>& fails);

}  // namespace eciton::chain::test

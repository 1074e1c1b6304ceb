// Drawing, printing and shrinking of schedules.
#include "tests/core/chain/schedule.hpp"

#include <algorithm>
#include <random>
#include <sstream>

namespace eciton::chain::test {
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double real() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  int integer(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
  Duration time(double least_s, double most_s) { return from_s(least_s + (most_s - least_s) * real()); }

 private:
  std::mt19937_64 random_;
};

void draw_of_kind(Draw& draw, EventKind kind, double rate_hz, Schedule& schedule) {
  const int ports = schedule.airframe == Airframe::chain ? 2 : 4;
  for (double at_s = draw.real() / rate_hz; at_s < to_s(schedule.faulty_for); at_s += 2 * draw.real() / rate_hz) {
    Event event{.at = from_s(at_s), .kind = kind};
    event.a = draw.integer(schedule.modules);
    event.b = kind == EventKind::split ? draw.integer(1 << schedule.modules) : draw.integer(schedule.modules);
    event.port = draw.integer(ports);
    event.span = draw.time(0, kind == EventKind::mute || kind == EventKind::claim_falsely ? 1.5 : 0.15);
    event.other_span = draw.time(0, 0.15);
    schedule.events.push_back(event);
    // What begins has an end of its own, so that either can be left out.
    Event end{.at = event.at + draw.time(0.05, 1.5), .a = event.a, .flag = draw.real() < 0.3};
    end.kind = kind == EventKind::crash ? EventKind::restart : EventKind::heal;
    if (kind == EventKind::crash || kind == EventKind::split) schedule.events.push_back(end);
  }
}

}  // namespace

Schedule draw_schedule(std::uint64_t seed, Airframe airframe) {
  Draw draw(seed);
  Schedule schedule{.seed = seed, .airframe = airframe, .events = {}};
  schedule.modules = 2 + std::min(draw.integer(15), draw.integer(15));  // large worlds take long
  schedule.loss = 0.6 * draw.real();
  schedule.clocks_known = draw.real() < 0.8;
  const double pace = 0.5 + draw.real();
  draw_of_kind(draw, EventKind::dock, pace * 3 * schedule.modules, schedule);  // most pairs drawn cannot dock
  draw_of_kind(draw, EventKind::undock, pace * 0.2 * schedule.modules, schedule);
  draw_of_kind(draw, EventKind::crash, pace, schedule);
  draw_of_kind(draw, EventKind::split, pace * 0.3, schedule);
  draw_of_kind(draw, EventKind::mute, pace * 0.4, schedule);
  draw_of_kind(draw, EventKind::claim_falsely, pace * 0.4, schedule);
  std::stable_sort(schedule.events.begin(), schedule.events.end(),
                   [](const Event& a, const Event& b) { return a.at < b.at; });
  return schedule;
}

std::string to_text(const Event& event) {
  std::ostringstream text;
  const auto name = [](int module) { return "module " + std::to_string(module + 1); };
  text << to_s(event.at) << " s: ";
  switch (event.kind) {
    case EventKind::dock:
      text << name(event.a) << " docks by port " << event.port << " to " << name(event.b);
      break;
    case EventKind::undock:
      text << name(event.a) << " undocks port " << event.port;
      break;
    case EventKind::crash:
      text << name(event.a) << " crashes";
      break;
    case EventKind::restart:
      text << name(event.a) << " restarts" << (event.flag ? " without its checkpoint" : "");
      break;
    case EventKind::split:
      text << "the radio splits off the modules of mask " << event.b;
      break;
    case EventKind::heal:
      text << "the radio joins again";
      break;
    case EventKind::mute:
      text << name(event.a) << " announces nothing for " << to_s(event.span) << " s";
      break;
    case EventKind::claim_falsely:
      text << name(event.a) << " claims for " << to_s(event.span) << " s to hold " << name(event.b) << " by port "
           << event.port;
      break;
  }
  return text.str();
}

std::string to_text(const Schedule& schedule) {
  std::ostringstream text;
  text << "seed " << schedule.seed << ", " << schedule.modules << " modules of a "
       << (schedule.airframe == Airframe::chain ? "chain" : "lattice") << ", loss " << schedule.loss << ", clocks "
       << (schedule.clocks_known ? "known" : "unknown") << ", faults until " << to_s(schedule.faulty_for) << " s\n";
  for (const Event& event : schedule.events) text << "  " << to_text(event) << '\n';
  return text.str();
}

namespace {

/// Takes over what `change` makes of the schedule, if that still fails.
template <class Change>
bool change_if_it_fails(Schedule& schedule, const std::function<bool(const Schedule&)>& fails, const Change& change) {
  Schedule candidate = schedule;
  change(candidate);
  if (candidate == schedule || !fails(candidate)) return false;
  schedule = candidate;
  return true;
}

bool leave_out_events(Schedule& schedule, const std::function<bool(const Schedule&)>& fails) {
  bool shorter = false;
  for (std::size_t group = std::max<std::size_t>(schedule.events.size() / 2, 1);; group = (group + 1) / 2) {
    for (std::size_t first = 0; first < schedule.events.size();) {
      const bool left_out = change_if_it_fails(schedule, fails, [&](Schedule& s) {
        const auto begin = s.events.begin() + static_cast<std::ptrdiff_t>(first);
        s.events.erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(group, s.events.size() - first)));
      });
      shorter |= left_out;
      if (!left_out) first += group;
    }
    if (group == 1) return shorter;
  }
}

/// The last module, or one that no event names, in whose place the last one then stands.
void leave_out_module(Schedule& schedule, int module) {
  const int last = --schedule.modules;
  std::erase_if(schedule.events, [&](const Event& e) {
    return e.a == module || (e.b == module && (e.kind == EventKind::dock || e.kind == EventKind::claim_falsely));
  });
  for (Event& event : schedule.events) {
    if (event.a == last) event.a = module;
    if (event.kind == EventKind::split) {
      const int bit = (event.b >> last) & 1;
      event.b = (event.b & ~(1 << last) & ~(1 << module)) | (module < last ? bit << module : 0);
    } else if (event.b == last) {
      event.b = module;
    }
  }
}

}  // namespace

Schedule shrink(Schedule schedule, const std::function<bool(const Schedule&)>& fails) {
  for (bool smaller = true; smaller;) {
    smaller = leave_out_events(schedule, fails);
    for (int module = schedule.modules - 1; module >= 0 && schedule.modules > 2; --module)
      smaller |= change_if_it_fails(schedule, fails, [&](Schedule& s) { leave_out_module(s, module); });
    smaller |= change_if_it_fails(schedule, fails, [](Schedule& s) { s.loss = 0; });
    smaller |= change_if_it_fails(schedule, fails, [](Schedule& s) { s.clocks_known = true; });
    smaller |= change_if_it_fails(schedule, fails, [](Schedule& s) {
      const Duration last = s.events.empty() ? Duration{} : s.events.back().at;
      s.faulty_for = std::min(s.faulty_for, last + 500ms);
    });
  }
  return schedule;
}

}  // namespace eciton::chain::test

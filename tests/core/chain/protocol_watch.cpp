// What must never happen in the chain protocol, and what must happen in time, judged from the world's truth.
#include <algorithm>
#include <sstream>

#include "tests/core/chain/protocol_world.hpp"

namespace eciton::chain::test {

void World::violate(const std::string& what) {
  if (result_.violation) return;
  std::ostringstream text;
  text << "seed " << config_.seed << ", " << to_s(now_) << " s, " << modules_.size() << " modules, loss " << loss_
       << ": " << what;
  result_.violation = text.str();
}

std::vector<int> World::component_of(int module) const {
  std::vector<int> found{module};
  for (std::size_t k = 0; k < found.size(); ++k) {
    for (const Port& port : modules_[found[k]].port) {
      if (port.peer >= 0 && std::find(found.begin(), found.end(), port.peer) == found.end())
        found.push_back(port.peer);
    }
  }
  return found;
}

/// A module is undisturbed while nothing happens that its component has to agree about or that keeps it from it.
void World::note_disturbances() {
  for (std::size_t k = 0; k < modules_.size(); ++k) {
    Module& module = modules_[k];
    for (const Port& port : module.port)
      module.disturbed = std::max(module.disturbed, port.changed + port.latch_delay);
    module.disturbed = std::max({module.disturbed, module.started, std::min(module.muted_until, now_)});
    for (std::size_t other = 0; other < modules_.size(); ++other) {
      if (modules_[other].live && modules_[other].group == module.group) module.could_hear[other] = now_;
    }
    for (const int other : component_of(static_cast<int>(k))) {
      if (!modules_[other].live || modules_[other].group != module.group) module.disturbed = now_;
    }
  }
}

void World::watch_convergence() {
  for (std::size_t k = 0; k < modules_.size(); ++k) {
    const auto component = component_of(static_cast<int>(k));
    Duration calm_since{};
    std::set<std::uint32_t> truth;
    for (const int other : component) {
      calm_since = std::max(calm_since, modules_[other].disturbed);
      truth.insert(modules_[other].id);
    }
    if (now_ - calm_since < config_.agreement_bound) continue;
    const auto& active = modules_[k].agreement->active();
    if (!active) return violate("module " + std::to_string(k + 1) + " is active in no view");
    if (std::set<std::uint32_t>(active->members.begin(), active->members.end()) != truth)
      return violate("module " + std::to_string(k + 1) + " flies a view that is not what is linked");
    for (const int other : component) {
      const auto& theirs = modules_[other].agreement->active();
      if (!theirs || !(*theirs == *active))
        return violate("linked modules " + std::to_string(k + 1) + " and " + std::to_string(other + 1) +
                       " fly different views");
    }
    for (const Link& link : active->links) {
      const Port& male = modules_[link.module - 1].port[link.port];
      if (male.peer + 1 != static_cast<int>(link.peer) || link.port != ChainRule::male_port)
        return violate("a view has a link that is not there");
    }
  }
}

void World::watch(Module& module) {
  const auto& active = module.agreement->active();
  const bool changed = active.has_value() && (!module.flown || module.flown->epoch != active->epoch);
  if (module.flown && !active) return violate("a module dropped its view without another");
  if (!changed) return;
  if (module.flown) watch_lost_links(module, *module.flown, *active);
  watch_new_view(module, *active);
  module.flown = *active;
  module.activated = now_;
}

void World::watch_lost_links(const Module& module, const View& before, const View& after) {
  for (const Link& link : before.links) {
    if (std::find(after.links.begin(), after.links.end(), link) != after.links.end()) continue;
    if (!after.contains(link.module) && !after.contains(link.peer)) continue;
    const Port& port = modules_[link.module - 1].port[link.port];
    if (port.peer + 1 == static_cast<int>(link.peer) && port.changed <= module.activated)
      violate("silence removed a link: module " + std::to_string(module.id) + " lost " + std::to_string(link.module) +
              "-" + std::to_string(link.peer));
  }
}

void World::watch_new_view(Module& module, const View& view) {
  const std::string who = "module " + std::to_string(module.id);
  if (!view.contains(module.id)) violate(who + " flies a view it is not in");
  if (view.epoch == 0) {
    if (view.members.size() != 1) violate(who + " flies a chain without an epoch");
    return;
  }
  if (!module.once_active.insert(view.epoch).second) violate(who + " made one epoch active twice");
  const TimePoint start = module.agreement->active_since();
  const bool first = view_of_.find(view.epoch) == view_of_.end();
  if (first) {
    ++result_.chains_activated;
    view_of_[view.epoch] = view;
    start_of_[view.epoch] = start;
  }
  if (!(view_of_[view.epoch] == view)) violate("one epoch stands for two views");
  if (start_of_[view.epoch] != start) violate("one epoch has two starts");
  const Module& base = modules_[view.base - 1];
  const Duration early = (start.time_since_epoch() - base.clock) - now_;
  if (early > (clocks_known_ ? Duration{2ms} : Duration{}) && (clocks_known_ || module.id == view.base))
    violate(who + " switched " + std::to_string(to_s(early)) + " s before the start");
  for (const std::uint32_t member : view.members) {
    if (announced_by_[view.epoch].count(member) == 0)
      violate(who + " flies a view that member " + std::to_string(member) + " never announced");
    // Silence is noticed after the time-out, and the last words may have been on their way for a while.
    const Duration gone = now_ - module.could_hear[member - 1];
    if (first && gone > FreshnessConfig{}.near_time_out + (delay_ticks_max + 1) * tick)
      violate("a view became active at module " + std::to_string(module.id) + " " + std::to_string(to_s(gone)) +
              " s after member " + std::to_string(member) + " fell silent");
  }
}

}  // namespace eciton::chain::test

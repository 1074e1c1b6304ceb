// What must never happen in the chain protocol, and what must happen in time, judged from the world's truth.
#include <algorithm>
#include <sstream>

#include "tests/core/chain/protocol_world.hpp"

namespace eciton::chain::test {

void World::violate(const std::string& what) {
  if (result_.violation) return;
  std::ostringstream text;
  text << "seed " << schedule_.seed << ", " << to_s(now_) << " s, " << modules_.size() << " modules, loss "
       << schedule_.loss << ": " << what;
  result_.violation = text.str();
}

void World::find_components() {
  components_.clear();
  component_at_.assign(modules_.size(), modules_.size());
  for (std::size_t k = 0; k < modules_.size(); ++k) {
    if (component_at_[k] != modules_.size()) continue;
    component_at_[k] = components_.size();
    std::vector<int> found{static_cast<int>(k)};
    for (std::size_t next = 0; next < found.size(); ++next) {
      for (const Port& port : modules_[found[next]].port) {
        if (port.peer < 0 || component_at_[port.peer] != modules_.size()) continue;
        component_at_[port.peer] = components_.size();
        found.push_back(port.peer);
      }
    }
    components_.push_back(std::move(found));
  }
}

bool World::refused(const std::vector<int>& component) const {
  return schedule_.airframe == Airframe::chain && std::all_of(component.begin(), component.end(), [&](int module) {
           return modules_[module].port[0].peer >= 0 && modules_[module].port[1].peer >= 0;
         });
}

/// A module is undisturbed while nothing happens that its component has to agree about or that keeps it from it.
void World::note_disturbances() {
  for (std::size_t k = 0; k < modules_.size(); ++k) {
    Module& module = modules_[k];
    for (const Port& port : module.port) {
      module.disturbed = std::max(module.disturbed, port.changed + port.latch_delay);
      module.disturbed = std::max(module.disturbed, std::min(port.false_until, now_));
    }
    module.disturbed = std::max({module.disturbed, module.started, std::min(module.muted_until, now_)});
    for (std::size_t other = 0; other < modules_.size(); ++other) {
      if (modules_[other].live && modules_[other].group == module.group) module.could_hear[other] = now_;
    }
    for (const int other : component_of(static_cast<int>(k))) {
      if (!modules_[other].live || modules_[other].group != module.group) module.disturbed = now_;
    }
  }
}

bool World::converged(const std::vector<int>& component) {
  const bool ring = refused(component);
  result_.refused += ring;
  const auto& active = modules_[component.front()].agreement->active();
  for (const int module : component) {
    const Agreement& agreement = *modules_[module].agreement;
    if (ring) {
      if (agreement.refusal() != Refusal::ring) return false;
      continue;
    }
    if (!active || !agreement.active() || !(*agreement.active() == *active)) return false;
    if (active->members.size() != component.size() || !active->contains(modules_[module].id)) return false;
  }
  if (ring) return true;
  std::size_t ends = 0;
  for (const int module : component) {
    for (const Port& port : modules_[module].port) ends += port.peer >= 0;
  }
  return ends == 2 * active->links.size() &&
         std::all_of(active->links.begin(), active->links.end(), [&](const Link& link) {
           const Port& port = modules_[link.module - 1].port[link.port];
           return port.peer + 1 == static_cast<int>(link.peer) && port.peer_port == static_cast<int>(link.peer_port);
         });
}

void World::watch_convergence() {
  for (const auto& component : components_) {
    Duration calm_since{};
    for (const int module : component) calm_since = std::max(calm_since, modules_[module].disturbed);
    const Duration calm_for = now_ - calm_since;
    if (calm_for <= result_.convergence_max || converged(component)) continue;
    result_.convergence_max = calm_for;
    if (calm_for < config_.agreement_bound) continue;
    std::string who;
    for (const int module : component) who += " " + std::to_string(module + 1);
    return violate("the linked modules" + who + " do not fly what is linked");
  }
}

void World::watch(Module& module) {
  const auto& active = module.agreement->active();
  const bool changed = active.has_value() && (!module.flown || module.flown->epoch != active->epoch);
  if (module.flown && !active) return violate("a module dropped its view without another");
  if (!changed) return;
  for (const std::uint64_t word : {std::uint64_t{module.id}, active->epoch, static_cast<std::uint64_t>(now_.count())})
    result_.digest = (result_.digest ^ word) * 0x9e3779b97f4a7c15u + (result_.digest >> 29);
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
  for (const Link& link : view.links) {
    if (ever_linked_.count(link) == 0) violate(who + " flies a link that never was");
  }
  if (view.links.size() >= view.members.size() && schedule_.airframe == Airframe::chain)
    violate(who + " flies a ring");
  result_.largest = std::max(result_.largest, static_cast<int>(view.members.size()));
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
  if (early > (schedule_.clocks_known ? Duration{2ms} : Duration{}) &&
      (schedule_.clocks_known || module.id == view.base))
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

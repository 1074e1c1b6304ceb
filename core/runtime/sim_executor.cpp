// One tick after another.
#include "core/runtime/sim_executor.hpp"

#include <algorithm>

namespace eciton::runtime {

namespace {

Pace to_pace(TimePoint t) { return t.time_since_epoch(); }

}  // namespace

SimModule::SimModule(const ExecutorConfig& config, std::vector<bus::Participant*> participants, const TimePoint& now)
    : group_(config, std::move(participants), ServiceGroup::Pacing::simulated), now_(now) {
  group_.start(to_pace(now_));
}

void SimModule::add(Service& service) {
  group_.add(service, to_pace(now_));
  changed_ = true;
}

void SimModule::remove(const Service& service) {
  group_.remove(service);
  changed_ = true;
}

void SimModule::suspend(const Service& service, bool suspended) {
  for (const auto& entry : group_.entries()) {
    if (entry->service == &service) entry->suspended = suspended;
  }
}

TimePoint SimModule::clock_at(TimePoint world) const {
  // In whole microseconds: the product stays in 64 bits for days at any drift a clock has.
  const auto elapsed_us = std::chrono::floor<std::chrono::microseconds>(world.time_since_epoch()).count();
  return world + clock_offset_ + Duration{elapsed_us * clock_drift_ppb_ / 1'000'000};
}

SimExecutor::SimExecutor(const SimConfig& config, Plant& plant, std::function<void(TimePoint)> advance_network)
    : config_(config), plant_(plant), advance_network_(std::move(advance_network)), now_(config.start) {
  if (config.tick <= Duration::zero()) throw BadInput{{"simulation: the tick must be over zero"}};
}

SimModule& SimExecutor::add_module(const ExecutorConfig& config, std::vector<bus::Participant*> participants) {
  modules_.push_back(std::make_unique<SimModule>(config, std::move(participants), now_));
  return *modules_.back();
}

void SimExecutor::collect_entries() {
  order_.clear();
  for (const auto& module : modules_) {
    for (const auto& entry : module->group().entries()) order_.push_back({module.get(), entry.get()});
    module->changed_ = false;
  }
  std::stable_sort(order_.begin(), order_.end(),
                   [](const Due& a, const Due& b) { return a.entry->schedule.phase < b.entry->schedule.phase; });
}

void SimExecutor::tick() {
  if (std::any_of(modules_.begin(), modules_.end(), [](const auto& module) { return module->changed_; })) {
    collect_entries();
  }
  if (advance_network_) advance_network_(now_);
  const Pace at = to_pace(now_);
  for (const Due& due : order_) {
    ServiceGroup& group = due.module->group();
    if (group.due(*due.entry, at)) group.step(*due.entry, at, due.module->clock_at(now_));
  }
  for (const auto& module : modules_) module->group().beat_if_due(at, module->clock_at(now_));
  for (const auto& observer : observers_) observer(now_);
  now_ += config_.tick;
  ++ticks_;
  plant_.advance(now_);
}

void SimExecutor::run_until(TimePoint end) {
  while (now_ < end) tick();
}

bool SimExecutor::run_until(const std::function<bool()>& done, TimePoint limit) {
  while (!done()) {
    if (now_ >= limit) return false;
    tick();
  }
  return true;
}

}  // namespace eciton::runtime

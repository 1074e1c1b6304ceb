// Keeps this module's own samples; peers' come over the radio and are theirs.
#include "deploy/command/module_ear.hpp"

#include <algorithm>

#include "core/base/wall_clock.hpp"

namespace eciton::deploy {

ModuleEar::ModuleEar(const bus::ParticipantConfig& config)
    : participant_(config),
      heartbeat_reader_(participant_.create_reader(topics::heartbeat)),
      state_reader_(participant_.create_reader(topics::module_state)),
      docking_reader_(participant_.create_reader(topics::docking_state)),
      view_reader_(participant_.create_reader(topics::chain_view)),
      radio_reader_(participant_.create_reader(topics::radio_state)),
      fault_reader_(participant_.create_reader(topics::fault)) {}

void ModuleEar::poll() {
  const Duration now = monotonic_now();
  while (const auto beat = heartbeat_reader_.take()) {
    heartbeats_[std::string(beat->value.service.view())] = {beat->value, now};
  }
  // Heartbeats stay on their ring, so they say whose ring this is.
  if (heartbeats_.empty()) return;
  const std::uint32_t own = heartbeats_.begin()->second.beat.module_id;
  while (const auto state = state_reader_.take()) {
    if (state->value.module_id == own) state_ = state->value;
  }
  while (const auto docking = docking_reader_.take()) {
    if (docking->value.module_id == own) docking_ = docking->value;
  }
  while (const auto view = view_reader_.take()) {
    if (view->value.module_id == own) view_ = view->value;
  }
  while (const auto radio = radio_reader_.take()) {
    if (radio->value.module_id == own) radio_ = radio->value;
  }
  while (const auto fault = fault_reader_.take()) {
    if (fault->value.module_id != own) continue;
    if (fault->value.severity == msg::Severity::error) ++errors_;
    // From several writers, each with its own past: not in the order of time.
    const auto later = [](const msg::Fault& a, const msg::Fault& b) { return a.stamp_ns < b.stamp_ns; };
    faults_.insert(std::upper_bound(faults_.begin(), faults_.end(), fault->value, later), fault->value);
    if (faults_.size() > faults_kept) faults_.pop_front();
  }
}

Duration ModuleEar::age_of(std::int64_t stamp_ns) const {
  const HeardHeartbeat* newest = nullptr;
  for (const auto& [service, heard] : heartbeats_) {
    if (newest == nullptr || heard.beat.stamp_ns > newest->beat.stamp_ns) newest = &heard;
  }
  if (newest == nullptr) return {};
  // A sample may be a little newer than the last heartbeat.
  return std::max(Duration{newest->beat.stamp_ns - stamp_ns} + (monotonic_now() - newest->arrived), Duration::zero());
}

std::optional<msg::FlightMode> ModuleEar::flight_mode() const {
  const auto control = heartbeats_.find("control");
  if (control == heartbeats_.end()) return std::nullopt;
  return control->second.beat.flight_mode;
}

}  // namespace eciton::deploy

// Bookkeeping of the newest of everything, module by module.
#include "deploy/operator/known_fleet.hpp"

#include <algorithm>
#include <chrono>

namespace eciton::deploy {
namespace {

constexpr Duration clocks_differ = std::chrono::seconds(1);
constexpr TimePoint never_heard{-std::chrono::hours(24 * 365 * 50)};  // a reader's newest stamp is before this

}  // namespace

KnownFleet::KnownFleet(bus::Participant& swarm)
    : swarm_(swarm),
      state_(swarm.create_reader(topics::module_state)),
      view_(swarm.create_reader(topics::chain_view)),
      docking_(swarm.create_reader(topics::docking_state)),
      beacon_(swarm.create_reader(topics::beacon)) {}

KnownModule& KnownFleet::note(std::uint32_t id) {
  auto [entry, is_new] = modules_.try_emplace(id);
  if (is_new) entry->second.first_heard = now_;
  entry->second.heard = now_;
  return entry->second;
}

template <class T>
void KnownFleet::take(bus::Reader<T>& reader, std::optional<T> KnownModule::*member) {
  while (const auto sample = reader.take()) note(sample->value.module_id).*member = sample->value;
}

void KnownFleet::poll(TimePoint now) {
  now_ = now;
  // The newest stamps first: they say what time it is, and by that the ages of samples are reckoned.
  state_.trigger().fetch();
  beacon_.trigger().fetch();
  const TimePoint newest = std::max(state_.trigger().newest_stamp(), beacon_.trigger().newest_stamp());
  const Duration ahead = newest - now;
  time_known_ = newest > never_heard;
  simulated_time_ = time_known_ && std::chrono::abs(ahead) > clocks_differ;
  module_now_ = simulated_time_ ? newest : now;
  swarm_.set_now(module_now_);
  take(state_, &KnownModule::state);
  take(view_, &KnownModule::view);
  take(docking_, &KnownModule::docking);
  take(beacon_, &KnownModule::beacon);
}

const KnownModule* KnownFleet::find(std::uint32_t id) const {
  const auto entry = modules_.find(id);
  return entry == modules_.end() ? nullptr : &entry->second;
}

std::string KnownFleet::heard() const {
  std::string text;
  for (const auto& [id, module] : modules_) text += (text.empty() ? "" : ", ") + std::to_string(id);
  return text.empty() ? "none" : text;
}

}  // namespace eciton::deploy

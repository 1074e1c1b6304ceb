// When services fall due, and what is done around each step.
#include "core/runtime/service_group.hpp"

#include <unistd.h>

#include <algorithm>

#include "core/base/contract.hpp"
#include "core/base/log.hpp"
#include "core/base/wall_clock.hpp"
#include "core/runtime/name_key.hpp"
#include "idl/topics.hpp"

namespace eciton::runtime {

namespace {

constexpr Duration checkpoint_period = std::chrono::milliseconds(50);

void check(const Service& service, const Schedule& schedule, const std::string& process) {
  const std::string who = "service " + std::string(service.name()) + " of " + process + ": ";
  if (service.name().empty() || service.name().size() > decltype(msg::Heartbeat::service)::bound()) {
    throw BadInput{{who + "its name must have 1 to 31 characters"}};
  }
  if (schedule.trigger == nullptr && schedule.period <= Duration::zero()) {
    throw BadInput{{who + "a periodic schedule needs a period over zero"}};
  }
  if (schedule.trigger != nullptr && schedule.at_most <= Duration::zero()) {
    throw BadInput{{who + "a schedule on topic " + std::string(schedule.trigger->topic().name) +
                    " needs an at_most over zero: the longest it may go without a step"}};
  }
}

}  // namespace

ServiceGroup::ServiceGroup(const ExecutorConfig& config, std::vector<bus::Participant*> participants, Pacing pacing)
    : config_(config), participants_(std::move(participants)), pacing_(pacing) {
  if (participants_.empty()) throw BadInput{{"process " + config_.process + ": an executor needs a participant"}};
  for (const bus::Participant* participant : participants_) {
    ECITON_EXPECT(&const_cast<bus::Participant*>(participant)->waker() == &waker(),
                  "the participants of one executor share one waker: give the first one's to the others");
  }
  if (config_.heartbeat_period > Duration::zero()) {
    heartbeat_.emplace(module_ring().create_writer(topics::heartbeat));
    radio_state_.emplace(module_ring().create_reader(topics::radio_state));
    radio_state_->trigger().set_wakes(false);
  }
}

ServiceGroup::Entry& ServiceGroup::add(Service& service, Pace at) {
  const Schedule schedule = service.schedule();
  check(service, schedule, config_.process);
  for (const auto& other : entries_) {
    if (other->service->name() == service.name()) {
      throw BadInput{{"process " + config_.process + " has two services named " + std::string(service.name())}};
    }
  }
  auto entry = std::make_unique<Entry>();
  entry->service = &service;
  entry->schedule = schedule;
  entry->next_due = entry->triggered() ? at + schedule.at_most : at;
  fill_constant_fields(*entry);
  if (!config_.checkpoints.empty() && service.state_version() != 0) take_up_checkpoint(*entry);
  const auto place = std::upper_bound(entries_.begin(), entries_.end(), schedule.phase,
                                      [](Phase phase, const auto& other) { return phase < other->schedule.phase; });
  return **entries_.insert(place, std::move(entry));
}

void ServiceGroup::remove(const Service& service) {
  std::erase_if(entries_, [&](const auto& entry) { return entry->service == &service; });
}

void ServiceGroup::fill_constant_fields(Entry& entry) {
  msg::Heartbeat& heartbeat = entry.heartbeat;
  heartbeat.module_id = config_.module_id;
  heartbeat.service_key = name_key(entry.service->name());
  heartbeat.service = entry.service->name();
  heartbeat.vendor = std::string_view(module_ring().config().vendor);
  heartbeat.pid = pacing_ != Pacing::simulated ? static_cast<std::uint32_t>(::getpid()) : 0;
}

void ServiceGroup::take_up_checkpoint(Entry& entry) {
  const std::string name(entry.service->name());
  entry.checkpoint =
      std::make_unique<Checkpoint>(*entry.service, checkpoint_file(config_.checkpoints, name), checkpoint_period);
  const auto loaded = entry.checkpoint->load();
  if (!loaded) spdlog::warn("{}: {}", name, loaded.error().message);
  if (loaded && *loaded) spdlog::info("{} goes on from its checkpoint", name);
  entry.checkpoint->start();
}

void ServiceGroup::start(Pace at) {
  if (heartbeat_) next_heartbeat_ = at;
  for (const auto& entry : entries_) entry->next_due = entry->triggered() ? at + entry->schedule.at_most : at;
}

void ServiceGroup::mute() {
  for (bus::Participant* participant : participants_) participant->set_all_wake(false);
}

void ServiceGroup::wake_by_triggers() {
  for (const auto& entry : entries_) {
    if (entry->triggered()) entry->schedule.trigger->set_wakes(true);
  }
}

bool ServiceGroup::due(Entry& entry, Pace at) noexcept {
  if (entry.suspended) return false;
  if (entry.triggered()) {
    bus::ReaderCore& trigger = *entry.schedule.trigger;
    trigger.fetch();
    if (trigger.has_sample() && trigger.news() != entry.news) return true;
  }
  return at >= entry.next_due;
}

Pace ServiceGroup::step(Entry& entry, Pace at, TimePoint now) noexcept {
  for (bus::Participant* participant : participants_) participant->set_now(now);
  bool sampled = false;
  if (entry.triggered()) {
    const bus::ReaderCore& trigger = *entry.schedule.trigger;
    sampled = trigger.has_sample() && trigger.news() != entry.news;
    entry.news = trigger.news();
  }
  const bool measured = pacing_ != Pacing::simulated;
  const Duration before = measured ? monotonic_now() : Duration::zero();
  entry.service->step(now);
  entry.steps.turn();
  const Duration execution = measured ? monotonic_now() - before : Duration::zero();
  entry.statistics.record(at, execution);
  if (entry.triggered()) {
    if (!sampled) entry.statistics.count_timeout();
    if (pacing_ == Pacing::wall_clock && execution > entry.schedule.at_most) entry.statistics.count_overruns(1);
    entry.next_due = at + entry.schedule.at_most;
    // Samples that come as often as at_most asks, give or take, are not preceded by time-outs.
    if (sampled && pacing_ == Pacing::wall_clock) entry.next_due += entry.schedule.at_most / 4;
  } else {
    const Duration period = entry.schedule.period;
    const std::int64_t skipped = std::max(at - entry.next_due, Duration::zero()) / period;
    entry.statistics.count_overruns(static_cast<std::uint64_t>(skipped));
    entry.next_due += (skipped + 1) * period;
  }
  return at + execution;
}

void ServiceGroup::beat_if_due(Pace at, TimePoint now) noexcept {
  if (at < next_heartbeat_) return;
  next_heartbeat_ += ((at - next_heartbeat_) / config_.heartbeat_period + 1) * config_.heartbeat_period;
  learn_clock_offsets();
  std::uint64_t dropped = 0;
  for (const bus::Participant* participant : participants_) dropped += participant->dropped();
  for (const auto& entry : entries_) {
    if (entry->suspended) continue;
    msg::Heartbeat& heartbeat = entry->heartbeat;
    heartbeat.stamp_ns = to_ns(now);
    heartbeat.dropped = dropped;
    heartbeat.lifecycle = msg::Lifecycle::active;
    entry->statistics.fill(heartbeat, at);
    entry->service->describe(heartbeat);
    heartbeat_->write(heartbeat);
  }
  if (at < next_checkpoint_) return;
  next_checkpoint_ = at + checkpoint_period;
  for (const auto& entry : entries_) {
    if (entry->checkpoint) entry->checkpoint->save();
  }
}

void ServiceGroup::say_farewell(TimePoint now) noexcept {
  if (!heartbeat_) return;
  for (const auto& entry : entries_) {
    entry->heartbeat.stamp_ns = to_ns(now);
    entry->heartbeat.lifecycle = msg::Lifecycle::finalized;
    heartbeat_->write(entry->heartbeat);
  }
}

std::string_view ServiceGroup::find_idle() noexcept {
  for (const auto& entry : entries_) {
    if (!entry->suspended && !entry->steps.has_turned()) return entry->service->name();
  }
  for (const auto& entry : entries_) entry->steps.note();
  return {};
}

Pace ServiceGroup::next_step_due() const noexcept {
  Pace next = Pace::max();
  for (const auto& entry : entries_) next = std::min(next, entry->next_due);
  return next;
}

void ServiceGroup::learn_clock_offsets() noexcept {
  // So that every process turns a peer's stamps into ages as the radio does.
  while (const auto radio = radio_state_->take()) {
    if (radio->value.module_id != config_.module_id) continue;
    for (const msg::PeerClock& peer : radio->value.peers) {
      for (bus::Participant* participant : participants_) {
        participant->set_clock_offset(peer.module_id, Duration{peer.offset_ns});
      }
    }
  }
}

Pace ServiceGroup::next_due() const noexcept { return std::min(next_step_due(), next_heartbeat_); }

bool ServiceGroup::has_triggers() const {
  return std::any_of(entries_.begin(), entries_.end(), [](const auto& entry) { return entry->triggered(); });
}

std::string ServiceGroup::table() const {
  std::string text = CycleStatistics::table_heading() + "\n";
  for (const auto& entry : entries_) text += entry->statistics.table_line(entry->service->name()) + "\n";
  return text;
}

}  // namespace eciton::runtime

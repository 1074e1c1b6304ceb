// One wake-up per message waited for: other readers do not signal, triggers only while they are waited for.
#include "core/runtime/lockstep_executor.hpp"

#include <algorithm>

#include "core/base/log.hpp"
#include "core/base/wall_clock.hpp"
#include "core/runtime/name_key.hpp"

namespace eciton::runtime {

LockstepExecutor::LockstepExecutor(const ExecutorConfig& config, std::vector<bus::Participant*> participants,
                                   Duration sample_wait)
    : Executor(config, std::move(participants), ServiceGroup::Pacing::lockstep),
      clock_(group_.module_ring().create_reader(topics::clock)),
      acks_(group_.module_ring().create_writer(topics::clock_ack)),
      sample_wait_(sample_wait) {
  if (!ack_.process.assign(config.process)) {
    throw BadInput{{"process " + config.process + ": in lockstep its name may have 31 characters"}};
  }
  ack_.process_key = name_key(config.process);
}

void LockstepExecutor::run(const StopFlag& stop) {
  group_.mute();
  clock_.trigger().set_wakes(true);
  silences_.assign(group_.entries().size(), {});
  Sleeper sleeper(group_.waker(), stop);
  while (!stop.requested()) {
    if (const auto clock = clock_.take_newest()) {
      follow(clock->value, sleeper);
    } else {
      sleeper.for_at_most(std::chrono::seconds(1));
    }
  }
}

void LockstepExecutor::follow(const msg::Clock& clock, Sleeper& sleeper) {
  const bool restarted = last_ && clock.tick < last_->tick;
  if (last_ && clock.tick == last_->tick) {
    ++counts_.repeated;
    acks_.write(ack_);
    return;
  }
  if (restarted)
    spdlog::warn("{}: the clock went back from tick {} to {}", ack_.process.view(), last_->tick, clock.tick);
  const bool first = !last_ || restarted;
  if (first) {
    group_.start(Pace{clock.stamp_ns});
    ack_.next_tick = 0;
  } else {
    learn_period(clock);
  }
  step_tick(clock, sleeper);
  last_ = clock;
}

void LockstepExecutor::step_tick(const msg::Clock& clock, Sleeper& sleeper) {
  ++counts_.ticks;
  const TimePoint now = from_ns(clock.stamp_ns);
  const Pace at{clock.stamp_ns};
  const Duration until = monotonic_now() + sample_wait_;
  std::optional<TimePoint> oldest_input;
  for (std::size_t k = 0; k < group_.entries().size(); ++k) {
    ServiceGroup::Entry& entry = *group_.entries()[k];
    const bool awaited =
        entry.triggered() && clock.imu_sampled && await_sample(entry, silences_[k], now, until, sleeper);
    if (!awaited && !group_.due(entry, at)) continue;
    group_.step(entry, at, now);
    if (!entry.triggered()) continue;
    const TimePoint input = entry.schedule.trigger->newest_stamp();
    oldest_input = std::min(oldest_input.value_or(input), input);
  }
  group_.beat_if_due(at, now);
  if (clock.tick < ack_.next_tick) return;  // nobody waits for us
  ack_.stamp_ns = clock.stamp_ns;
  ack_.tick = clock.tick;
  ack_.next_tick = next_tick(clock);
  ack_.input_stamp_ns = oldest_input ? std::max<std::int64_t>(to_ns(*oldest_input), 0) : 0;
  acks_.write(ack_);
}

bool LockstepExecutor::await_sample(ServiceGroup::Entry& entry, Silence& silence, TimePoint stamp, Duration until,
                                    Sleeper& sleeper) {
  bus::ReaderCore& trigger = *entry.schedule.trigger;
  trigger.fetch();
  if (silence.silent && trigger.newest_stamp() > silence.newest) silence.silent = false;
  if (silence.silent) return false;
  // Armed before the look, so that no sample slips between the look and the sleep.
  trigger.set_wakes(true);
  for (trigger.fetch(); trigger.newest_stamp() < stamp; trigger.fetch()) {
    const Duration left = until - monotonic_now();
    if (left <= Duration::zero() || sleeper.stopped()) {
      ++counts_.unsampled;
      silence = {true, trigger.newest_stamp()};
      break;
    }
    sleeper.for_at_most(left);
  }
  trigger.set_wakes(false);
  return true;
}

void LockstepExecutor::learn_period(const msg::Clock& clock) {
  const auto ticks = static_cast<std::int64_t>(clock.tick - last_->tick);
  const std::int64_t elapsed_ns = clock.stamp_ns - last_->stamp_ns;
  tick_period_ = Duration{elapsed_ns > 0 && elapsed_ns % ticks == 0 ? elapsed_ns / ticks : 0};
}

std::uint64_t LockstepExecutor::next_tick(const msg::Clock& clock) const {
  constexpr std::int64_t at_most = 1'000'000;
  if (group_.has_triggers() || tick_period_ <= Duration::zero()) return clock.tick + 1;
  const Duration left = group_.next_step_due() - Pace{clock.stamp_ns};
  const std::int64_t ticks = left / tick_period_ + (left % tick_period_ > Duration::zero() ? 1 : 0);
  return clock.tick + static_cast<std::uint64_t>(std::clamp<std::int64_t>(ticks, 1, at_most));
}

}  // namespace eciton::runtime

// Who has acknowledged what.
#include "core/runtime/lockstep_master.hpp"

#include <algorithm>
#include <cstdio>

#include "core/base/contract.hpp"
#include "core/base/wall_clock.hpp"
#include "core/runtime/name_key.hpp"

namespace eciton::runtime {

LockstepMaster::LockstepMaster(bus::Participant& participant, const std::vector<std::string>& processes,
                               const StopFlag& stop, Duration publish_again_after)
    : clock_(participant.create_writer(topics::clock)),
      acks_(participant.create_reader(topics::clock_ack)),
      sleeper_(participant.waker(), stop),
      publish_again_after_(publish_again_after) {
  acks_.trigger().set_wakes(true);
  for (const std::string& name : processes) {
    Process process{.name = name, .key = name_key(name)};
    const auto same = std::find_if(processes_.begin(), processes_.end(),
                                   [&](const Process& other) { return other.key == process.key; });
    if (same != processes_.end()) {
      throw BadInput{{"lockstep: the processes " + same->name + " and " + name + " share a key; name one otherwise"}};
    }
    processes_.push_back(std::move(process));
  }
}

void LockstepMaster::publish(std::uint64_t tick, TimePoint stamp, bool imu_sampled) {
  current_ = {.stamp_ns = to_ns(stamp), .tick = tick, .imu_sampled = imu_sampled};
  clock_.write(current_);
}

bool LockstepMaster::is_missing(const Process& process) const {
  return !process.heard || (process.last_tick < current_.tick && process.next_tick <= current_.tick);
}

void LockstepMaster::note(const msg::ClockAck& ack) {
  const auto process = std::find_if(processes_.begin(), processes_.end(),
                                    [&](const Process& other) { return other.key == ack.process_key; });
  if (process == processes_.end() || ack.tick > current_.tick) return;  // not ours, or of a run before
  const bool repeated = process->heard && process->last_tick == ack.tick;
  process->heard = true;
  process->last_tick = ack.tick;
  process->next_tick = ack.next_tick;
  const bool acted_on_older = ack.input_stamp_ns != 0 && ack.input_stamp_ns < ack.stamp_ns;
  if (!repeated && ack.tick == current_.tick && current_.imu_sampled && acted_on_older) ++stale_inputs_;
}

bool LockstepMaster::all_acknowledged() {
  while (const auto ack = acks_.take()) note(ack->value);
  return std::none_of(processes_.begin(), processes_.end(), [this](const Process& p) { return is_missing(p); });
}

Status LockstepMaster::wait_for_acks(Duration timeout) {
  const Duration start = monotonic_now();
  Duration again = start + publish_again_after_;
  while (!all_acknowledged()) {
    const Duration now = monotonic_now();
    if (now - start >= timeout || sleeper_.stopped()) return missing(now - start);
    if (now >= again) {
      clock_.write(current_);
      ++published_again_;
      again = now + publish_again_after_;
    }
    sleeper_.for_at_most(std::min(again, start + timeout) - now);
  }
  return ok();
}

Error LockstepMaster::missing(Duration timeout) const {
  char head[96];
  std::snprintf(head, sizeof head, "lockstep stalls at tick %llu (%.3f s), after %.1f s of waiting for ",
                static_cast<unsigned long long>(current_.tick), static_cast<double>(current_.stamp_ns) * 1e-9,
                to_s(timeout));
  std::string message = head;
  const char* separator = "";
  for (const Process& process : processes_) {
    if (!is_missing(process)) continue;
    message += separator + process.name;
    message += process.heard ? " (its last: tick " + std::to_string(process.last_tick) + ")" : " (never heard)";
    separator = ", ";
  }
  return {message};
}

}  // namespace eciton::runtime

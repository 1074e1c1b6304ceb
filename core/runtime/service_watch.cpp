// Stamps move on with time that does not count, so that every comparison is with the present alone.
#include "core/runtime/service_watch.hpp"

#include <algorithm>

namespace eciton::runtime {

void ServiceWatch::begin(TimePoint now) noexcept {
  const Duration passed = now - now_.value_or(now);
  now_ = now;
  if (passed >= Duration::zero() && passed <= period_ + config_.beat) return;
  for (Watched& w : watched_) {
    w.alive_at += passed;
    w.settled_at += passed;
  }
}

void ServiceWatch::hear(std::uint32_t key, std::string_view service, TimePoint stamp, bool farewell) noexcept {
  if (!now_ || service.empty()) return;
  const auto same = [&](const Watched& w) { return !w.service.empty() && w.key == key; };
  auto place = std::find_if(watched_.begin(), watched_.end(), same);
  const bool known = place != watched_.end();
  if (!known)
    place = std::find_if(watched_.begin(), watched_.end(), [](const Watched& w) { return w.service.empty(); });
  if (place == watched_.end()) return;
  Watched& w = *place;
  if (farewell) {
    w = {};
    return;
  }
  stamp = std::min(stamp, *now_);
  const Duration gap = stamp - w.alive_at;
  if (!known) {
    w.key = key;
    w.service.assign(service);
  } else if (w.silent) {
    w.back_after = gap;
  }
  if (!known || w.silent || gap > config_.patience) w.settled_at = stamp + config_.settling;
  w.silent = false;
  w.alive_at = known ? std::max(w.alive_at, stamp) : stamp;
}

std::optional<ServiceWatch::Notice> ServiceWatch::next_notice() noexcept {
  for (Watched& w : watched_) {
    if (w.service.empty()) continue;
    if (w.back_after) {
      const Notice back{.service = w.service.view(), .silent = false, .silence = *w.back_after};
      w.back_after.reset();
      return back;
    }
    const Duration silence = *now_ - w.alive_at;
    const bool settled = w.alive_at >= w.settled_at;
    if (w.silent || silence <= (settled ? config_.patience : config_.settling_patience)) continue;
    w.silent = true;
    ++silences_;
    return Notice{.service = w.service.view(), .silent = true, .silence = silence};
  }
  return std::nullopt;
}

std::size_t ServiceWatch::silent_services() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(watched_.begin(), watched_.end(), [](const Watched& w) { return w.silent; }));
}

}  // namespace eciton::runtime

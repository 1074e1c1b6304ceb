// Notices to words.
#include "core/runtime/heartbeat_watch.hpp"

#include <array>
#include <cstdio>

namespace eciton::runtime {

void HeartbeatWatch::begin(TimePoint now) noexcept {
  now_ = now;
  watch_.begin(now);
}

void HeartbeatWatch::hear(const msg::Heartbeat& heartbeat) noexcept {
  if (heartbeat.module_id != module_id_ || heartbeat.service.view() == watcher_) return;
  watch_.hear(heartbeat.service_key, heartbeat.service.view(), from_ns(heartbeat.stamp_ns),
              heartbeat.lifecycle == msg::Lifecycle::finalized);
}

void HeartbeatWatch::tell(bus::Writer<msg::Fault>& faults) noexcept {
  while (const auto notice = watch_.next_notice()) {
    // What is back is no error any more, but the end of one is wanted where its beginning is.
    msg::Fault fault{.module_id = module_id_,
                     .stamp_ns = to_ns(now_),
                     .severity = notice->silent ? msg::Severity::error : msg::Severity::info,
                     .service = watcher_,
                     .device = notice->service,
                     .text = {}};
    std::array<char, decltype(fault.text)::bound() + 1> text{};
    const int size = static_cast<int>(notice->service.size());
    if (notice->silent) {
      std::snprintf(text.data(), text.size(),
                    "%.*s has been silent for %.0f ms: it died or hangs, and is to be restarted", size,
                    notice->service.data(), 1e3 * to_s(notice->silence));
    } else {
      std::snprintf(text.data(), text.size(), "%.*s is back: it was silent for %.3f s", size, notice->service.data(),
                    to_s(notice->silence));
    }
    fault.text.assign(text.data());
    faults.write(fault);
  }
}

}  // namespace eciton::runtime

// Intervals kept on the average, not sample by sample.
#include "services/radio/rate_limit.hpp"

#include <algorithm>

namespace eciton::radio {

RateLimit::Entry& RateLimit::entry_of(std::uint64_t key, TimePoint now) {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
  if (found != entries_.end()) return *found;
  if (entries_.push_back({key, now})) return entries_.back();
  Entry& oldest = *std::min_element(entries_.begin(), entries_.end(),
                                    [](const Entry& a, const Entry& b) { return a.due < b.due; });
  oldest = {key, now};
  return oldest;
}

bool RateLimit::allow(TimePoint now, std::uint64_t key) {
  if (interval_ <= Duration{}) return true;
  Entry& entry = entry_of(key, now);
  if (entry.due > now + 2 * interval_) entry.due = now;  // the clock was set back
  // A tenth of slack, so that a period that just misses its due time does not halve the rate.
  if (now < entry.due - interval_ / 10) {
    ++dropped_;
    return false;
  }
  entry.due = std::max(entry.due, now - interval_) + interval_;
  return true;
}

}  // namespace eciton::radio

// Incarnations that take turns.
#include "services/radio/duplicate_id.hpp"

#include <algorithm>
#include <utility>

namespace eciton::radio {

void DuplicateId::hear(TimePoint now, std::uint64_t incarnation, TimePoint stamp) {
  if (current_ && current_->incarnation == incarnation) {
    current_->stamp = std::max(current_->stamp, stamp);
  } else if (previous_ && previous_->incarnation == incarnation) {
    if (stamp <= previous_->stamp) return;
    previous_->stamp = stamp;
    std::swap(current_, previous_);
    returns_ = now - last_return_ > config_.forget_after ? 1 : returns_ + 1;
    last_return_ = now;
  } else {
    previous_ = std::exchange(current_, Life{incarnation, stamp});
  }
}

bool DuplicateId::met(TimePoint now) const {
  return returns_ >= config_.returns && now - last_return_ <= config_.forget_after;
}

}  // namespace eciton::radio

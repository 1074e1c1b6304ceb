// A ring of tenths of the window.
#include "services/radio/airtime.hpp"

#include <numeric>

namespace eciton::radio {

void Airtime::advance(TimePoint now) {
  const std::int64_t slot = now.time_since_epoch() / (config_.window / slots);
  // A clock set back, too, leaves nothing in the window to speak of.
  if (slot < slot_ || slot - slot_ >= slots) {
    bytes_.fill(0);
  } else {
    for (std::int64_t k = slot_ + 1; k <= slot; ++k) bytes_[static_cast<std::size_t>(k % slots)] = 0;
  }
  slot_ = slot;
}

void Airtime::add(TimePoint now, std::size_t payload_bytes) {
  advance(now);
  bytes_[static_cast<std::size_t>(slot_ % slots)] += payload_bytes + config_.overhead_bytes;
}

double Airtime::share(TimePoint now) {
  advance(now);
  const auto bytes = std::accumulate(bytes_.begin(), bytes_.end(), std::uint64_t{0});
  return 8.0 * static_cast<double>(bytes) / (config_.budget_bit_s * to_s(config_.window));
}

}  // namespace eciton::radio

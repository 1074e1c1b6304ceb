// How long a member has not been heard, and what that makes of it. Silence never removes a member.
#pragma once

#include "core/base/time.hpp"

namespace eciton::chain {

enum class Freshness : std::uint8_t {
  fresh,
  silent,  // not heard for too long; still a member
  left     // gone by latch evidence or withdrawal; the active view has yet to follow
};

struct FreshnessConfig {
  Duration near_time_out = 250ms;  // approaching or in a chain: 100 Hz of wrenches are heard; noticed in <= 300 ms
  Duration idle_time_out = 5s;     // beacons every 2 s: two may be lost; noticed in <= 6 s
};

constexpr bool is_fresh(Duration since_last_heard, bool near, const FreshnessConfig& config) {
  return since_last_heard <= (near ? config.near_time_out : config.idle_time_out);
}

}  // namespace eciton::chain

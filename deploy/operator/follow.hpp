// Follows goals to their end for a person: says what becomes of each, in a bounded time.
#pragma once

#include <cstdint>
#include <vector>

#include "core/runtime/stop_signal.hpp"
#include "deploy/operator/operator.hpp"

namespace eciton::deploy {

struct FollowConfig {
  Duration timeout = std::chrono::seconds(60);         // of the modules' clock; ten times as much of the wall clock
  Duration hearing_timeout = std::chrono::seconds(8);  // wall clock, until all goals are sent
};

enum class Followed { succeeded, failed, interrupted };

/// Waits until all the goals are over; what is not is given up. `swarm` is the operator's participant.
Followed follow(Operator& op, bus::Participant& swarm, const std::vector<std::uint64_t>& goals,
                const FollowConfig& config, const runtime::StopFlag& stop);

/// What became of a goal, for people: "goto 2: refused: it is disarmed".
std::string describe(const GoalReport& report);

}  // namespace eciton::deploy

// Flies a path and holds the flight against what the goal promised: the spline through its waypoints.
#pragma once

#include <span>

#include "deploy/experiments/chain_flight.hpp"

namespace eciton::deploy {

/// From rest at `flight.home()`, of a module alone or of a chain's base; the recorder records from the start of the
/// path to its end. Whether it was flown to its end within the limit.
bool fly_path(ChainFlight& flight, std::span<const robot::Pose> waypoints, double speed_m_s, double limit_s);

}  // namespace eciton::deploy

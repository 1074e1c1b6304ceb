// The reference of a path goal, and the flight along it.
#include "deploy/experiments/path_reference.hpp"

#include <memory>

#include "core/robot/arrays.hpp"
#include "services/control/flight_reference.hpp"

namespace eciton::deploy {

bool fly_path(ChainFlight& flight, std::span<const robot::Pose> waypoints, double speed_m_s, double limit_s) {
  std::vector<msg::Waypoint> points;
  for (const robot::Pose& X : waypoints) {
    points.push_back({.p_WM_m = robot::array(X.p), .q_WM = robot::quaternion(X.R)});
  }
  Pilot& pilot = flight.pilot();
  const std::uint64_t goal = pilot.op().fly_path(flight.base(), points, speed_m_s);
  pilot.wait_until([&] { return pilot.op().report(goal)->progress >= GoalProgress::accepted; }, limit_s);
  const double start_s = to_s(pilot.op().report(goal)->starts_at - TimePoint{}) -
                         (to_s(flight.simulation().now() - TimePoint{}) - flight.simulation().elapsed_s());
  auto path = std::make_shared<control::FlightReference>(flight.simulation().world().airframe(),
                                                         control::FlightReferenceConfig{});
  path->hold(flight.home());
  path->follow(waypoints, speed_m_s, start_s, start_s);
  flight.recorder().follow(flight.base(), [path](double elapsed_s) { return path->at(elapsed_s); });
  flight.recorder().start();
  const bool flown = pilot.follow(goal, limit_s) == GoalProgress::succeeded;
  flight.recorder().stop();
  return flown;
}

}  // namespace eciton::deploy

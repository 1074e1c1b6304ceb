// The end of a demo: tables for people and one JSON object, of what was flown and how the processes did.
#pragma once

#include "deploy/command/demo_fleet.hpp"
#include "deploy/command/demo_flight.hpp"
#include "deploy/command/measurement.hpp"

namespace eciton::deploy {

void print_report(const DemoOptions& options, const DemoFleet& fleet, const DemoFlight& flight,
                  const Launches& launches);

Measurement demo_measurement(const DemoOptions& options, const DemoFleet& fleet, const DemoFlight& flight,
                             const Launches& launches);

/// Which step failed and why, and the last lines of the logs that may tell more; on standard error.
void print_failure(const FlightFailure& failure, const DemoFlight& flight, const Launches& launches);

}  // namespace eciton::deploy

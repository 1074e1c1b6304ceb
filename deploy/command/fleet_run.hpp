// A fleet's processes from first to last: planned, claimed, started, flown, and nothing of them left behind.
#pragma once

#include <functional>

#include "core/runtime/stop_signal.hpp"
#include "deploy/command/demo_fleet.hpp"

namespace eciton::deploy {

inline constexpr int interrupted_status = 130;  // of a command that was asked to end

using FlyFleet = std::function<void(const DemoOptions& resolved, const DemoFleet& fleet, Launches& launches)>;

/// Throws BadInput when it cannot be planned or started.
void run_fleet(const DemoOptions& options, runtime::StopFlag& stop, const FlyFleet& fly);

}  // namespace eciton::deploy

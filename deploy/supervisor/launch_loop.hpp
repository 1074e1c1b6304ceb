// Looks after several launches at once: the part that `up` and `demo` share.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deploy/supervisor/launch.hpp"

namespace eciton::deploy {

using Launches = std::vector<std::unique_ptr<Launch>>;

/// Claims all of them, or none.
Result<Launches> claim_all(const std::vector<LaunchPlan>& plans);
/// Starts all of them, in order.
Status start_all(Launches& launches);

/// Asks all their processes to end, then waits for them side by side; directories and claims stay.
void stop_all(Launches& launches);

/// Waits for an end of a process, a due restart, a readable extra descriptor or `timeout`, then checks all launches.
void watch(Launches& launches, const std::vector<int>& extra_descriptors, Duration timeout,
           const std::function<void(Launch&, const ChildReport&)>& on_end);

/// "m2/control: it ended with exit status 2: no such key"
std::string describe(const Launch& launch, const ChildReport& report);

}  // namespace eciton::deploy

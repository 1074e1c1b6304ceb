// The process's log: spdlog to standard error, asynchronous, so that a logging thread never waits.
// Never called from a step: what a step has to say is an Event or a Fault.
#pragma once

#include <spdlog/spdlog.h>

#include <string_view>

namespace eciton {

/// Once per process, before the first log line. `level`: trace, debug, info, warn, error, off.
void start_log(std::string_view process, std::string_view level = "info");

}  // namespace eciton

// The verbs `eciton bench latency | jitter | path | formation`: options here, measuring in benchmarks/.
#pragma once

#include "deploy/command/command_line.hpp"

namespace eciton::deploy {

void add_bench(CLI::App& app, Run& run);

/// Each in a file of its own, under the verb `bench`.
void add_bench_latency(CLI::App& bench, Run& run);

}  // namespace eciton::deploy

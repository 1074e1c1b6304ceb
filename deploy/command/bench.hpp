// The verbs `eciton bench latency | jitter | path | formation`: options here, measuring in benchmarks/.
#pragma once

#include <functional>
#include <string>

#include "benchmarks/path/progress.hpp"
#include "benchmarks/report/result.hpp"
#include "deploy/command/command_line.hpp"

namespace eciton::deploy {

void add_bench(CLI::App& app, Run& run);

/// Each in a file of its own, under the verb `bench`.
void add_bench_formation(CLI::App& bench, Run& run);
void add_bench_jitter(CLI::App& bench, Run& run);
void add_bench_latency(CLI::App& bench, Run& run);
void add_bench_path(CLI::App& bench, Run& run);

/// --json, --csv and --html.
void add_report_options(CLI::App& verb, bench::ReportFiles& files);

/// Measures until it is done or interrupted, and tells the result. The exit status: 0, 1 when something that was
/// asked for is missing, 130 when interrupted.
int measure_and_tell(const std::string& command, const bench::ReportFiles& files,
                     const std::function<bench::Result(const runtime::StopFlag&, const bench::Progress&)>& measure);

}  // namespace eciton::deploy

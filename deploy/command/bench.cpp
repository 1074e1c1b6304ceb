// The benches, as subcommands of one verb.
#include "deploy/command/bench.hpp"

namespace eciton::deploy {

void add_bench(CLI::App& app, Run& run) {
  CLI::App& verb = *app.add_subcommand("bench", "Measures latency and jitter beside what others offer");
  verb.require_subcommand(1);
  add_bench_latency(verb, run);
}

}  // namespace eciton::deploy

// The `eciton` command: the list of its verbs, each in a file of its own.
#include "deploy/command/bench.hpp"
#include "deploy/command/chaos.hpp"
#include "deploy/command/command_line.hpp"
#include "deploy/command/demo.hpp"
#include "deploy/command/down.hpp"
#include "deploy/command/experiment.hpp"
#include "deploy/command/fly.hpp"
#include "deploy/command/net.hpp"
#include "deploy/command/status.hpp"
#include "deploy/command/topic.hpp"
#include "deploy/command/up.hpp"

int main(int argc, char** argv) {
  using namespace eciton::deploy;
  return run_command_line(argc, argv,
                          {&add_fly, &add_up, &add_down, &add_status, &add_demo, &add_chaos, &add_net,
                           &add_experiment, &add_topic, &add_bench});
}

// One process of a module in lockstep: lockstep_peer VENDOR DOMAIN ROLE, with ROLE one of estimation, control,
// docking. For tests that stop, kill and restart processes.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/runtime/lockstep_executor.hpp"
#include "tests/core/runtime/fake_services.hpp"

namespace {

using namespace eciton;
using namespace eciton::runtime;

void run(const std::string& vendor, std::uint32_t domain, const std::string& role) {
  StopFlag stop;
  const StopOnSignals stops(stop);
  bus::Participant ring({.vendor = vendor, .domain = domain, .name = role});
  testing::FakeEstimation estimation(ring, 1);
  testing::FakeControl control(ring, 1);
  testing::FakeService docking("docking", every(20ms, Phase::coordinate));
  LockstepExecutor executor({.module_id = 1, .process = role}, {&ring});
  if (role == "estimation") executor.add(estimation);
  if (role == "control") executor.add(control);
  if (role == "docking") executor.add(docking);
  executor.run(stop);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("lockstep_peer VENDOR DOMAIN ROLE\n", stderr);
    return 2;
  }
  try {
    run(argv[1], static_cast<std::uint32_t>(std::atoi(argv[2])), argv[3]);
  } catch (const BadInput& wrong) {
    std::fprintf(stderr, "%s\n", wrong.error.message.c_str());
    return 2;
  }
  return 0;
}

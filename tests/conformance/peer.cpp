// The peer that dies: writes its claim once and its state every PERIOD_US until it is killed.
// peer VENDOR DOMAIN INCARNATION PERIOD_US
#include <cstdio>
#include <cstdlib>

#include "tests/conformance/ring.hpp"

int main(int argc, char** argv) {
  using namespace eciton;
  if (argc != 5) {
    std::fprintf(stderr, "usage: %s VENDOR DOMAIN INCARNATION PERIOD_US\n", argv[0]);
    return 2;
  }
  auto config = bus::conformance::config_of(argv[1], static_cast<std::uint32_t>(std::atoi(argv[2])),
                                            bus::conformance::short_lease);
  try {
    bus::Participant participant(config);
    auto claims = participant.create_writer(topics::link_claim);
    auto states = participant.create_writer(topics::module_state);
    auto claim = bus::conformance::claim(7, 0, 1);
    claim.incarnation = std::strtoull(argv[3], nullptr, 10);
    claims.write(claim);
    const auto period = std::chrono::microseconds(std::atoi(argv[4]));
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);  // should nobody kill it
    for (std::int64_t k = 0; std::chrono::steady_clock::now() < end; ++k) {
      states.write(bus::conformance::state_at(7, k));
      std::this_thread::sleep_for(period);
    }
  } catch (const BadInput& bad) {
    std::fprintf(stderr, "%s\n", bad.error.message.c_str());
    return 2;
  }
  return 0;
}

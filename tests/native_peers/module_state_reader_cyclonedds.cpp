// Example: where the modules are, read by a program that shares nothing with Eciton but idl/state.idl, with Cyclone
// DDS. Usage: module_state_reader_cyclonedds DOMAIN [SECONDS]. A module's own ring is domain 10 + its id, on
// loopback.
#include <dds/dds.h>
#undef restrict

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "native_cyclonedds/state.h"

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: %s DOMAIN [SECONDS]\n", arguments[0]);
    return 2;
  }
  const auto domain = static_cast<dds_domainid_t>(std::strtoul(arguments[1], nullptr, 10));
  const double seconds = count > 2 ? std::strtod(arguments[2], nullptr) : 1e9;

  // Eciton's module rings live on loopback, so that is where to listen.
  dds_create_domain(domain,
                    "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface name=\"lo\" "
                    "multicast=\"true\"/></Interfaces><AllowMulticast>spdp</AllowMulticast></General></Domain>"
                    "</CycloneDDS>");
  const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
  const dds_entity_t topic =
      dds_create_topic(participant, &eciton_msg_ModuleState_desc, "module_state", nullptr, nullptr);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);  // the newest of each module
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, nullptr);
  dds_delete_qos(qos);
  if (reader < 0) {
    std::fprintf(stderr, "cannot read domain %u: %s\n", domain, dds_strretcode(-reader));
    return 1;
  }

  const dds_time_t end = dds_time() + static_cast<dds_duration_t>(seconds * 1e9);
  while (dds_time() < end) {
    constexpr std::uint32_t kAtOnce = 16;
    void* samples[kAtOnce] = {nullptr};
    dds_sample_info_t infos[kAtOnce];
    const dds_return_t taken = dds_take(reader, samples, infos, kAtOnce, kAtOnce);
    for (dds_return_t k = 0; k < taken; ++k) {
      if (!infos[k].valid_data) continue;
      const auto* state = static_cast<const eciton_msg_ModuleState*>(samples[k]);
      std::printf("module %u at (%7.3f %7.3f %7.3f) m, q (%6.3f %6.3f %6.3f %6.3f)\n", state->module_id,
                  state->p_WM_m[0], state->p_WM_m[1], state->p_WM_m[2], state->q_WM[0], state->q_WM[1],
                  state->q_WM[2], state->q_WM[3]);
    }
    if (taken > 0) dds_return_loan(reader, samples, taken);
    std::fflush(stdout);
    dds_sleepfor(DDS_MSECS(100));
  }
  dds_delete(participant);
  return 0;
}

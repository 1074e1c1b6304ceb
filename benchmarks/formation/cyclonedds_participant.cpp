// Cyclone DDS, C API, no configuration.
#include <dds/dds.h>

#include <cstdlib>
#include <stdexcept>

#include "bench_cyclonedds/payload.h"
#include "benchmarks/formation/native_participant.hpp"

namespace eciton::bench {
namespace {

dds_entity_t checked(dds_entity_t entity, const std::string& what) {
  if (entity < 0) throw std::runtime_error("Cyclone DDS refuses " + what + ": " + dds_strretcode(-entity));
  return entity;
}

class CycloneParticipant final : public NativeParticipant {
 public:
  CycloneParticipant(std::uint32_t domain, const std::vector<std::string>& topics)
      : participant_(checked(dds_create_participant(domain, nullptr, nullptr), "a participant")) {
    for (const std::string& name : topics) {
      const dds_entity_t topic = checked(
          dds_create_topic(participant_, &eciton_bench_Payload256_desc, name.c_str(), nullptr, nullptr), name);
      checked(dds_create_writer(participant_, topic, nullptr, nullptr), "a writer of " + name);
      checked(dds_create_reader(participant_, topic, nullptr, nullptr), "a reader of " + name);
    }
  }
  ~CycloneParticipant() override { dds_delete(participant_); }

 private:
  dds_entity_t participant_;
};

}  // namespace

std::unique_ptr<NativeParticipant> make_cyclonedds_participant(std::uint32_t domain,
                                                               const std::vector<std::string>& topics) {
  ::unsetenv("CYCLONEDDS_URI");
  return std::make_unique<CycloneParticipant>(domain, topics);
}

}  // namespace eciton::bench

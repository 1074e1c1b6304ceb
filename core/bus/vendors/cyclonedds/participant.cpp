// Participant of Cyclone DDS: its name goes out with discovery, so that foreign tools show it.
#include "core/bus/vendors/cyclonedds/entities.hpp"
#include "core/bus/vendors/request.hpp"

using eciton::Error;
using eciton::Result;

Result<eciton_participant*> eciton_participant::create(const eciton_participant_config& config) {
  if (const eciton::Status checked = eciton::bus::vendors::check_participant(config); !checked) {
    return checked.error();
  }
  Result<eciton::bus::cyclonedds::SharedDomain> domain = eciton::bus::cyclonedds::SharedDomain::acquire(config);
  if (!domain) return domain.error();
  dds_qos_t* qos = dds_create_qos();
  dds_qset_entity_name(qos, config.name);
  const dds_entity_t participant = dds_create_participant(config.domain, qos, nullptr);
  dds_delete_qos(qos);
  if (participant < 0) {
    return Error{"participant \"" + std::string(config.name) + "\": Cyclone DDS cannot join domain " +
                 std::to_string(config.domain) + ": " + dds_strretcode(-participant)};
  }
  return new eciton_participant{std::move(domain).value(), config.name, config.domain,
                                eciton::bus::cyclonedds::Entity(participant)};
}

std::string eciton_participant::label() const {
  return "participant \"" + name + "\" in domain " + std::to_string(domain_id);
}

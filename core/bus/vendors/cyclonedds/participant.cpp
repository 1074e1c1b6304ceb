// Participant of Cyclone DDS: its name goes out with discovery, so that foreign tools show it.
#include <cstring>
#include <memory>

#include "core/bus/vendors/cyclonedds/entities.hpp"
#include "core/bus/vendors/request.hpp"

using eciton::Error;
using eciton::Result;

eciton_participant::eciton_participant(eciton::bus::cyclonedds::SharedDomain&& in,
                                       const eciton_participant_config& config)
    : domain(std::move(in)), name(config.name), domain_id(config.domain), reannouncer_([this] { announce(); }) {}

Result<eciton_participant*> eciton_participant::create(const eciton_participant_config& config) {
  if (const eciton::Status checked = eciton::bus::vendors::check_participant(config); !checked) {
    return checked.error();
  }
  Result<eciton::bus::cyclonedds::SharedDomain> domain = eciton::bus::cyclonedds::SharedDomain::acquire(config);
  if (!domain) return domain.error();
  std::unique_ptr<eciton_participant> created(new eciton_participant(std::move(domain).value(), config));
  dds_qos_t* qos = dds_create_qos();
  dds_qset_entity_name(qos, config.name);
  const dds_entity_t participant = [&] {
    const std::lock_guard lock(eciton::bus::cyclonedds::WithoutKeyHashes::mutex());
    return dds_create_participant(config.domain, qos, nullptr);
  }();
  dds_delete_qos(qos);
  if (participant < 0) {
    return Error{"participant \"" + std::string(config.name) + "\": Cyclone DDS cannot join domain " +
                 std::to_string(config.domain) + ": " + dds_strretcode(-participant)};
  }
  created->participant.reset(participant);
  dds_listener_t* listener = dds_create_listener(created.get());
  dds_lset_data_available(listener, &eciton_participant::on_discovery);
  const dds_entity_t discovery = dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, listener);
  dds_delete_listener(listener);
  if (discovery < 0) {
    return Error{created->label() + ": Cyclone DDS does not list participants: " + dds_strretcode(-discovery)};
  }
  created->discovery_.reset(discovery);
  created->reannouncer_.started();
  return created.release();
}

void eciton_participant::on_discovery(dds_entity_t reader, void* self) {
  constexpr std::uint8_t kFastDds[2] = {0x01, 0x0f};  // how the GUIDs of that vendor begin
  void* samples[1] = {nullptr};
  dds_sample_info_t info;
  while (dds_take(reader, samples, &info, 1, 1) > 0) {
    const auto* found = static_cast<const dds_builtintopic_participant_t*>(samples[0]);
    if (info.valid_data && info.view_state == DDS_VST_NEW &&  // new, and no announcement repeated
        std::memcmp(found->key.v, kFastDds, sizeof kFastDds) == 0) {
      static_cast<eciton_participant*>(self)->reannouncer_.discovered();
    }
    dds_return_loan(reader, samples, 1);
  }
}

// A participant is announced when its QoS changes: user data is the part that means nothing to anyone.
void eciton_participant::announce() {
  if (!participant.good()) return;
  ++announcement_;
  dds_qos_t* qos = dds_create_qos();
  dds_qset_userdata(qos, &announcement_, sizeof announcement_);
  dds_set_qos(participant.get(), qos);
  dds_delete_qos(qos);
}

std::string eciton_participant::label() const {
  return "participant \"" + name + "\" in domain " + std::to_string(domain_id);
}

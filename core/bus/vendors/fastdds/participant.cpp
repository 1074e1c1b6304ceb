// Participant of Fast DDS: UDP on one interface, no shared memory, discovery by multicast or by peers.
#include "core/bus/vendors/fastdds/participant.hpp"

#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <cstdlib>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <memory>

#include "core/bus/vendors/fastdds/bytes_type.hpp"
#include "core/bus/vendors/fastdds/fast_discovery.hpp"
#include "core/bus/vendors/fastdds/lean_transport.hpp"
#include "core/bus/vendors/network.hpp"
#include "core/bus/vendors/request.hpp"

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eciton::Error;
using eciton::Result;
using eprosima::fastrtps::Duration_t;

namespace {

// Enough for a burst of every topic of a module; the kernel grants less where net.core.rmem_max is lower.
constexpr std::uint32_t kSocketBufferBytes = 1u << 20;

Duration_t milliseconds(std::uint32_t ms) { return {static_cast<std::int32_t>(ms / 1000), ms % 1000 * 1'000'000u}; }

rtps::Locator_t locator(const std::string& address) {
  rtps::Locator_t result;  // port 0: the well-known one of the domain
  rtps::IPLocator::setIPv4(result, address);
  return result;
}

void set_discovery(rtps::BuiltinAttributes& builtin, const std::string& address,
                   const eciton_participant_config& config, const std::vector<std::string>& peers) {
  auto& discovery = builtin.discovery_config;
  const auto pace = eciton::bus::vendors::announcement_pace(config.lease_ms, peers);
  discovery.leaseDuration = milliseconds(pace.lease_ms);
  discovery.leaseDuration_announcementperiod = milliseconds(pace.period_ms);
  // A peer that starts at the same moment misses the first announcement: repeat it soon.
  discovery.initial_announcements.count = 3;
  discovery.initial_announcements.period = milliseconds(30);
  if (peers.empty()) return;
  builtin.avoid_builtin_multicast = true;
  rtps::Locator_t own = locator(address);
  // The vendor counts participants over all domains of a process, so that a radio would not be the first of its host.
  if (eciton::bus::vendors::unicast_range(peers).announced_to == 1) {
    own.port = static_cast<std::uint32_t>(eciton::bus::vendors::free_discovery_port(config.domain));
  }
  builtin.metatrafficUnicastLocatorList.push_back(own);  // one given: no multicast one is added
  for (const std::string& peer : peers) builtin.initialPeersList.push_back(locator(peer));
}

fast::DomainParticipantQos participant_qos(const eciton_participant_config& config, const std::string& address,
                                           const std::vector<std::string>& peers) {
  fast::DomainParticipantQos qos;
  qos.name(config.name);
  qos.transport().use_builtin_transports = false;  // these would bring shared memory and every interface
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back(address);
  udp->non_blocking_send = true;  // a full socket buffer loses the packet, it never holds up a step
  udp->sendBufferSize = kSocketBufferBytes;
  udp->receiveBufferSize = kSocketBufferBytes;
  udp->maxInitialPeersRange = static_cast<std::uint32_t>(eciton::bus::vendors::unicast_range(peers).announced_to);
  qos.transport().user_transports.push_back(eciton::bus::fastdds::lean_transport(udp));
  set_discovery(qos.wire_protocol().builtin, address, config, peers);
  return qos;
}

// Profiles from files apply to defaults only, and no default is used here. The one thing in the environment that
// would still win is the discovery server of ROS 2, which replaces the discovery asked for.
void ignore_environment() {
  for (const char* variable : {"ROS_DISCOVERY_SERVER", "FASTDDS_ENVIRONMENT_FILE"}) {
    if (std::getenv(variable) != nullptr) unsetenv(variable);
  }
}

}  // namespace

Result<eciton_participant*> eciton_participant::create(const eciton_participant_config& config) {
  if (const eciton::Status checked = eciton::bus::vendors::check_participant(config); !checked) {
    return checked.error();
  }
  const auto address = eciton::bus::vendors::interface_address(config.network_interface);
  if (!address) return address.error();
  const auto peers = eciton::bus::vendors::peer_addresses(config.peers, config.peer_count);
  if (!peers) return peers.error();
  ignore_environment();
  std::unique_ptr<eciton_participant> created(new eciton_participant);
  created->participant = fast::DomainParticipantFactory::get_instance()->create_participant(
      config.domain, participant_qos(config, *address, *peers), created.get(), fast::StatusMask::none());
  if (created->participant == nullptr) {
    return Error{"participant \"" + std::string(config.name) + "\": Fast DDS cannot open domain " +
                 std::to_string(config.domain) + " on " + config.network_interface + " (" + *address +
                 "); are its ports from " + std::to_string(7400 + 250 * config.domain) + " on taken?"};
  }
  eciton::bus::fastdds::hasten_discovery(*created->participant);
  created->publisher = created->participant->create_publisher(fast::PublisherQos());
  created->subscriber = created->participant->create_subscriber(fast::SubscriberQos());
  if (created->publisher == nullptr || created->subscriber == nullptr) {
    return Error{created->label() + ": Fast DDS cannot create a publisher and a subscriber"};
  }
  created->announced_ = created->participant;
  created->reannouncer_.started();
  return created.release();
}

eciton_participant::~eciton_participant() {
  reannouncer_.stop();
  if (participant == nullptr) return;
  participant->delete_contained_entities();
  fast::DomainParticipantFactory::get_instance()->delete_participant(participant);
}

void eciton_participant::on_participant_discovery(fast::DomainParticipant* self,
                                                  rtps::ParticipantDiscoveryInfo&& found) {
  if (found.status == rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT &&
      found.info.m_VendorId == rtps::c_VendorId_eProsima) {
    announced_ = self;
    reannouncer_.discovered();
  }
}

void eciton_participant::announce() {
  if (const fast::DomainParticipant* self = announced_) eciton::bus::fastdds::announce(*self);
}

std::string eciton_participant::label() const {
  return "participant \"" + participant->get_qos().name().to_string() + "\" in domain " +
         std::to_string(participant->get_domain_id());
}

Result<fast::Topic*> eciton_participant::topic(const char* name, const eciton_type& type) {
  fast::TypeSupport known = participant->find_type(type.name);
  if (known.empty()) {
    known = fast::TypeSupport(new eciton::bus::fastdds::BytesType(type));
    if (known.register_type(participant) != ReturnCode_t::RETCODE_OK) {
      return Error{label() + ": Fast DDS refuses the type " + type.name};
    }
  }
  if (known->m_typeSize != type.size_max || known->m_isGetKeyDefined != (type.key_size > 0)) {
    return Error{label() + ": type " + type.name + " was declared before with another size or key"};
  }
  if (fast::TopicDescription* existing = participant->lookup_topicdescription(name)) {
    if (existing->get_type_name() == type.name) return static_cast<fast::Topic*>(existing);
    return Error{label() + ": topic \"" + name + "\" has type " + existing->get_type_name() + ", not " + type.name};
  }
  fast::Topic* created = participant->create_topic(name, type.name, fast::TopicQos());
  if (created == nullptr) return Error{label() + ": Fast DDS cannot create topic \"" + std::string(name) + "\""};
  return created;
}

bool eciton_participant::owns(const rtps::InstanceHandle_t& endpoint) const {
  return std::memcmp(endpoint.value, participant->guid().guidPrefix.value, rtps::GuidPrefix_t::size) == 0;
}

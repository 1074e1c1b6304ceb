// Declares the three functions of Fast DDS that it takes, weakly, and calls them where they exist.
#include "core/bus/vendors/fastdds/fast_discovery.hpp"

#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/writer/StatefulWriter.h>
#include <fastdds/rtps/common/EntityId_t.hpp>

namespace eprosima::fastrtps::rtps {

class RTPSParticipantImpl {
 public:
  [[gnu::weak]] void announceRTPSParticipantState();
};

class RTPSDomainImpl {
 public:
  [[gnu::weak]] static RTPSWriter* find_local_writer(const GUID_t& guid);
  [[gnu::weak]] static RTPSParticipantImpl* find_local_participant(const GUID_t& guid);
};

}  // namespace eprosima::fastrtps::rtps

namespace eciton::bus::fastdds {

namespace rtps = eprosima::fastrtps::rtps;

void hasten_discovery(const eprosima::fastdds::dds::DomainParticipant& participant) {
  if (&rtps::RTPSDomainImpl::find_local_writer == nullptr) return;
  rtps::WriterTimes times;
  times.heartbeatPeriod = eprosima::fastrtps::Duration_t(0, 50'000'000);   // 1 s; only while something is unanswered
  times.nackResponseDelay = eprosima::fastrtps::Duration_t(0, 1'000'000);  // 100 ms
  times.nackSupressionDuration = eprosima::fastrtps::Duration_t(0, 10'000'000);
  for (const rtps::EntityId_t& entity : {rtps::c_EntityId_SEDPPubWriter, rtps::c_EntityId_SEDPSubWriter}) {
    rtps::RTPSWriter* writer = rtps::RTPSDomainImpl::find_local_writer({participant.guid().guidPrefix, entity});
    if (auto* announcer = dynamic_cast<rtps::StatefulWriter*>(writer)) announcer->updateTimes(times);
  }
}

void announce(const eprosima::fastdds::dds::DomainParticipant& participant) {
  if (&rtps::RTPSDomainImpl::find_local_participant == nullptr) return;
  rtps::RTPSParticipantImpl* implementation = rtps::RTPSDomainImpl::find_local_participant(participant.guid());
  if (implementation != nullptr) implementation->announceRTPSParticipantState();
}

}  // namespace eciton::bus::fastdds

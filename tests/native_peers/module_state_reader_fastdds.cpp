// Example: where the modules are, read by a program that shares nothing with Eciton but idl/state.idl, with Fast DDS.
// Usage: module_state_reader_fastdds DOMAIN [SECONDS]. A module's own ring is domain 10 + its id, on loopback.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <thread>

#include "native_fastdds/statePubSubTypes.h"

namespace fast = eprosima::fastdds::dds;

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: %s DOMAIN [SECONDS]\n", arguments[0]);
    return 2;
  }
  const auto domain = static_cast<std::uint32_t>(std::strtoul(arguments[1], nullptr, 10));
  const double seconds = count > 2 ? std::strtod(arguments[2], nullptr) : 1e9;

  // Eciton's module rings live on loopback, so that is where to listen.
  fast::DomainParticipantQos participant_qos;
  participant_qos.transport().use_builtin_transports = false;
  const auto loopback = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  loopback->interfaceWhiteList.push_back("127.0.0.1");
  participant_qos.transport().user_transports.push_back(loopback);
  fast::DomainParticipant* participant =
      fast::DomainParticipantFactory::get_instance()->create_participant(domain, participant_qos);
  fast::TypeSupport type(new eciton::msg::ModuleStatePubSubType);
  type.register_type(participant);
  fast::Topic* topic = participant->create_topic("module_state", type.get_type_name(), fast::TopicQos());
  fast::DataReaderQos qos;  // best effort, the newest of each module
  fast::DataReader* reader = participant->create_subscriber(fast::SubscriberQos())->create_datareader(topic, qos);

  const auto start = std::chrono::steady_clock::now();
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds) {
    eciton::msg::ModuleState state;
    fast::SampleInfo info;
    while (reader->take_next_sample(&state, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      std::printf("module %u at (%7.3f %7.3f %7.3f) m, q (%6.3f %6.3f %6.3f %6.3f)\n", state.module_id(),
                  state.p_WM_m()[0], state.p_WM_m()[1], state.p_WM_m()[2], state.q_WM()[0], state.q_WM()[1],
                  state.q_WM()[2], state.q_WM()[3]);
    }
    std::fflush(stdout);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  participant->delete_contained_entities();
  fast::DomainParticipantFactory::get_instance()->delete_participant(participant);
  return 0;
}

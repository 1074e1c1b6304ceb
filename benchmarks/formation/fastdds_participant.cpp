// Fast DDS, its defaults throughout.
#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <stdexcept>

#include "bench_fastdds/payloadPubSubTypes.h"
#include "benchmarks/formation/native_participant.hpp"

namespace eciton::bench {
namespace {

namespace fast = eprosima::fastdds::dds;

template <class Entity>
Entity* checked(Entity* entity, const std::string& what) {
  if (entity == nullptr) throw std::runtime_error("Fast DDS refuses " + what);
  return entity;
}

class FastParticipant final : public NativeParticipant {
 public:
  FastParticipant(std::uint32_t domain, const std::vector<std::string>& topics)
      : participant_(checked(
            fast::DomainParticipantFactory::get_instance()->create_participant(domain, fast::PARTICIPANT_QOS_DEFAULT),
            "a participant")) {
    const fast::TypeSupport type(new ::eciton::bench::Payload256PubSubType);
    type.register_type(participant_);
    auto* publisher = checked(participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT), "a publisher");
    auto* subscriber = checked(participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT), "a subscriber");
    for (const std::string& name : topics) {
      auto* topic = checked(participant_->create_topic(name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT), name);
      checked(publisher->create_datawriter(topic, fast::DATAWRITER_QOS_DEFAULT), "a writer of " + name);
      checked(subscriber->create_datareader(topic, fast::DATAREADER_QOS_DEFAULT), "a reader of " + name);
    }
  }
  ~FastParticipant() override {
    participant_->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

 private:
  fast::DomainParticipant* participant_;
};

}  // namespace

std::unique_ptr<NativeParticipant> make_fastdds_participant(std::uint32_t domain,
                                                            const std::vector<std::string>& topics) {
  for (const char* variable : {"FASTRTPS_DEFAULT_PROFILES_FILE", "ROS_DISCOVERY_SERVER"}) ::unsetenv(variable);
  return std::make_unique<FastParticipant>(domain, topics);
}

}  // namespace eciton::bench

// A program that knows Eciton only by its IDL, on Fast DDS and what fastddsgen makes of it.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include "native_fastdds/all.hpp"
#include "tests/native_peers/peer_main.hpp"
#include "tests/native_peers/visitors.hpp"

namespace eciton::native_peers {

namespace fast = eprosima::fastdds::dds;

template <std::size_t Bound>
struct Text<eprosima::fastrtps::fixed_string<Bound>> {
  static constexpr bool is_text = true;
  static void assign(eprosima::fastrtps::fixed_string<Bound>& field, const std::string& value) { field = value; }
  static std::string get(const eprosima::fastrtps::fixed_string<Bound>& field) { return field.c_str(); }
};
template <class Element>
struct Sequence<std::vector<Element>> {
  static constexpr bool is_sequence = true;
  static void resize(std::vector<Element>& field, std::uint32_t size) { field.resize(size); }
  static std::uint32_t size(const std::vector<Element>& field) { return static_cast<std::uint32_t>(field.size()); }
  static Element& at(std::vector<Element>& field, std::uint32_t k) { return field[k]; }
};

#define ECITON_NATIVE_TYPE(name) eciton::msg::name
#define ECITON_NATIVE_FIELD(name) name()
#include "native_fields/all.inc"

namespace {

struct Node {
  fast::DomainParticipant* participant;
  fast::Publisher* publisher;
  fast::Subscriber* subscriber;
};

Node join(std::uint32_t domain) {
  fast::DomainParticipantQos qos;
  qos.name("native_fastdds");
  qos.transport().use_builtin_transports = false;
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back("127.0.0.1");
  qos.transport().user_transports.push_back(udp);
  fast::DomainParticipant* participant =
      fast::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
  if (participant == nullptr) std::exit(1);
  return {participant, participant->create_publisher(fast::PublisherQos()),
          participant->create_subscriber(fast::SubscriberQos())};
}

template <class Sample, class PubSubType>
class FastChannel final : public Channel {
 public:
  FastChannel(const Node& node, const char* topic, TopicQos qos)
      : node_(node), name_(topic), qos_(qos), support_(new PubSubType) {}

  const char* topic() const override { return name_; }
  std::vector<std::uint8_t> bytes(std::uint64_t seed) override {
    Sample sample = filled(seed);
    eprosima::fastrtps::rtps::SerializedPayload_t payload(support_->m_typeSize);
    if (!support_->serialize(&sample, &payload)) std::exit(1);
    return {payload.data, payload.data + payload.length};
  }
  void open_writer() override {
    fast::DataWriterQos qos;
    set(qos);
    writer_ = node_.publisher->create_datawriter(topic_description(), qos);
    if (writer_ == nullptr) std::exit(1);
  }
  void open_reader() override {
    fast::DataReaderQos qos;
    set(qos);
    reader_ = node_.subscriber->create_datareader(topic_description(), qos);
    if (reader_ == nullptr) std::exit(1);
  }
  void write(std::uint64_t seed) override {
    Sample sample = filled(seed);
    writer_->write(&sample);
  }
  bool read(std::uint64_t& seen) override {
    Sample sample;
    fast::SampleInfo info;
    while (reader_->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      std::uint64_t seed = 0;
      while (seed < kSeeds && !matches(sample, seed)) ++seed;
      if (seed == kSeeds) return false;
      seen |= std::uint64_t{1} << seed;
    }
    return true;
  }

 private:
  template <class EndpointQos>
  void set(EndpointQos& qos) const {
    qos.reliability().kind = qos_.reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
    qos.durability().kind =
        qos_.transient_local ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
    qos.history().depth = qos_.depth;
    // By default types of fixed size and without a key would go through files in /dev/shm, which who is killed
    // leaves.
    qos.data_sharing().off();
  }
  fast::Topic* topic_description() {
    support_.register_type(node_.participant);
    return node_.participant->create_topic(name_, support_.get_type_name(), fast::TopicQos());
  }
  Sample filled(std::uint64_t seed) const {
    Sample sample;
    Fill fill(name_, seed);
    visit_fields(fill, sample);
    return sample;
  }
  bool matches(Sample& sample, std::uint64_t seed) const {
    Compare compare(name_, seed);
    visit_fields(compare, sample);
    return compare.equal();
  }

  Node node_;
  const char* name_;
  TopicQos qos_;
  fast::TypeSupport support_;
  fast::DataWriter* writer_ = nullptr;
  fast::DataReader* reader_ = nullptr;
};

Channels channels(std::uint32_t domain) {
  const Node node = join(domain);
  Channels all;
#define TOPIC(name, type, reliable, transient_local, depth)                                      \
  all.push_back(std::make_unique<FastChannel<eciton::msg::type, eciton::msg::type##PubSubType>>( \
      node, #name, TopicQos{reliable, transient_local, depth}));
#include "tests/native_peers/topics.def"
#undef TOPIC
  return all;
}

}  // namespace
}  // namespace eciton::native_peers

int main(int count, char** arguments) {
  const int status = eciton::native_peers::peer_main(count, arguments, eciton::native_peers::channels);
  std::fflush(stdout);
  _exit(status);  // Entities are not taken down: the framework must stand peers that just go.
}

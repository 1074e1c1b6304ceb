// Native Fast DDS: its C++ API and the types that fastddsgen makes, under a participant that the plugin's own code
// creates, and endpoints of the QoS that it gives, so that all settings are the same by construction. inline: a
// listener on the reader. wake: a WaitSet with the reader's status condition.
#include <fastdds/dds/core/condition/GuardCondition.hpp>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "benchmarks/latency/peers/transport.hpp"
#include "core/base/wall_clock.hpp"
#include "core/bus/vendors/fastdds/participant.hpp"
#include "core/bus/vendors/fastdds/qos.hpp"

#include "bench_fastdds/payloadPubSubTypes.h"

namespace eciton::bench {
namespace {

namespace fast = eprosima::fastdds::dds;
using eprosima::fastrtps::Duration_t;

eciton_qos asked(const PeerOptions& options) {
  return {.reliable = options.reliable, .transient_local = 0, .depth = 1, .instances_max = 64};
}

class Lane : public fast::DataReaderListener {
 public:
  virtual bool send(const Mark& mark) noexcept = 0;
  virtual void take() noexcept = 0;
  bool matched() const {
    fast::PublicationMatchedStatus readers;
    fast::SubscriptionMatchedStatus writers;
    writer->get_publication_matched_status(readers);
    reader->get_subscription_matched_status(writers);
    return readers.current_count > 0 && writers.current_count > 0;
  }
  void on_data_available(fast::DataReader*) override { take(); }

  fast::DataWriter* writer = nullptr;
  fast::DataReader* reader = nullptr;
};

template <class Payload, class PayloadPubSubType>
class LaneOf final : public Lane {
 public:
  LaneOf(eciton_participant& in, const PeerOptions& options, std::uint32_t bytes, Sink& sink) : sink_(sink) {
    fast::TypeSupport type(new PayloadPubSubType);
    type.register_type(in.participant);
    const auto topic = [&](Role of) {
      return in.participant->create_topic(topic_name(options, of, bytes), type.get_type_name(), fast::TopicQos());
    };
    const bool listens = options.delivery == Delivery::inlined;
    writer = in.publisher->create_datawriter(topic(options.role), bus::fastdds::writer_qos(asked(options)));
    reader = in.subscriber->create_datareader(
        topic(other(options.role)), bus::fastdds::reader_qos(asked(options)), listens ? this : nullptr,
        listens ? fast::StatusMask::data_available() : fast::StatusMask::none());
    if (writer == nullptr || reader == nullptr) throw BadInput{{"Fast DDS cannot create a writer and a reader"}};
    out_.module_id(1);
    fill(out_.values());
  }

  bool send(const Mark& mark) noexcept override {
    out_.number(mark.sequence);
    out_.stamp_ns(mark.stamp_ns);
    return writer->write(&out_);
  }
  void take() noexcept override {
    fast::SampleInfo info;
    while (reader->take_next_sample(&in_, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) sink_.arrived({in_.number(), in_.stamp_ns()}, is_filled(in_.values()));
    }
  }

 private:
  Sink& sink_;
  Payload out_, in_;
};

class FastTransport final : public Transport {
 public:
  FastTransport(const PeerOptions& options, Sink& sink) : options_(options) {
    std::vector<const char*> peers;
    for (const std::string& peer : options.peers) peers.push_back(peer.c_str());
    const eciton_participant_config config{.domain = options.domain,
                                           .name = options.role == Role::ping ? "bench_ping" : "bench_echo",
                                           .network_interface = options.network_interface.c_str(),
                                           .peers = peers.data(),
                                           .peer_count = static_cast<std::uint32_t>(peers.size()),
                                           .lease_ms = 3000};
    participant_.reset(value_or_throw(eciton_participant::create(config)));
    lanes_[0] = std::make_unique<LaneOf<Payload64, Payload64PubSubType>>(*participant_, options, 64, sink);
    lanes_[1] = std::make_unique<LaneOf<Payload256, Payload256PubSubType>>(*participant_, options, 256, sink);
    lanes_[2] = std::make_unique<LaneOf<Payload1024, Payload1024PubSubType>>(*participant_, options, 1024, sink);
    lanes_[3] = std::make_unique<LaneOf<Payload4096, Payload4096PubSubType>>(*participant_, options, 4096, sink);
    waitset_.attach_condition(guard_);
    lane_ = lanes_[0].get();
  }

  bool matched() override {
    return std::all_of(lanes_.begin(), lanes_.end(), [](const auto& lane) { return lane->matched(); });
  }
  void select(std::uint32_t bytes) override {
    const auto found = std::find(payload_sizes.begin(), payload_sizes.end(), bytes);
    if (found == payload_sizes.end()) return;
    if (options_.delivery == Delivery::wake) waitset_.detach_condition(lane_->reader->get_statuscondition());
    lane_ = lanes_[found - payload_sizes.begin()].get();
    if (options_.delivery == Delivery::inlined) return;
    lane_->reader->get_statuscondition().set_enabled_statuses(fast::StatusMask::data_available());
    waitset_.attach_condition(lane_->reader->get_statuscondition());
  }
  bool send(const Mark& mark) noexcept override { return lane_->send(mark); }
  void wait_until(std::int64_t monotonic_ns) noexcept override {
    const std::int64_t left_ns = std::max<std::int64_t>(monotonic_ns - monotonic_now().count(), 0);
    const Duration_t left(static_cast<std::int32_t>(left_ns / 1'000'000'000),
                          static_cast<std::uint32_t>(left_ns % 1'000'000'000));
    if (waitset_.wait(triggered_, left) != ReturnCode_t::RETCODE_OK) return;
    for (fast::Condition* each : triggered_) {
      if (each == &guard_) {
        guard_.set_trigger_value(false);
      } else {
        lane_->take();
      }
    }
  }
  void interrupt() noexcept override { guard_.set_trigger_value(true); }

 private:
  PeerOptions options_;
  std::unique_ptr<eciton_participant> participant_;
  fast::WaitSet waitset_;
  fast::GuardCondition guard_;
  fast::ConditionSeq triggered_;
  std::array<std::unique_ptr<Lane>, payload_sizes.size()> lanes_;
  Lane* lane_ = nullptr;
};

std::unique_ptr<Transport> make(const PeerOptions& options, Sink& sink) {
  return std::make_unique<FastTransport>(options, sink);
}

}  // namespace
}  // namespace eciton::bench

int main(int argc, char** argv) { return eciton::bench::peer_main(argc, argv, eciton::bench::make); }

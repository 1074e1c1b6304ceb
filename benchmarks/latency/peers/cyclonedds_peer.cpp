// Native Cyclone DDS: its C API and the types that idlc makes, in a domain and participant that the plugin's own code
// opens, and endpoints of the QoS that it gives, so that settings are the same by construction, but for one: the
// domain's key hashes (24 bytes, some tens of nanoseconds) stay with these samples. inline: a listener on the reader.
// wake: a waitset with a read condition.
#include "benchmarks/latency/peers/transport.hpp"
#include "core/base/wall_clock.hpp"
#include "core/bus/vendors/cyclonedds/entities.hpp"
#include "core/bus/vendors/cyclonedds/qos.hpp"

#include "bench_cyclonedds/payload.h"

namespace eciton::bench {
namespace {

using bus::cyclonedds::Qos;

Qos make_qos(const PeerOptions& options) {
  return bus::cyclonedds::make_qos(
      {.reliable = options.reliable, .transient_local = 0, .depth = 1, .instances_max = 64});
}

dds_entity_t good(dds_entity_t entity, const char* what) {
  if (entity < 0)
    throw BadInput{{"Cyclone DDS cannot create a " + std::string(what) + ": " + dds_strretcode(-entity)}};
  return entity;
}

struct Lane {
  dds_entity_t writer = 0, reader = 0, condition = 0;
  bool (*send)(dds_entity_t writer, const Mark& mark) = nullptr;
  void (*take)(dds_entity_t reader, Sink& sink) = nullptr;

  bool matched() const {
    dds_publication_matched_status_t readers{};
    dds_subscription_matched_status_t writers{};
    dds_get_publication_matched_status(writer, &readers);
    dds_get_subscription_matched_status(reader, &writers);
    return readers.current_count > 0 && writers.current_count > 0;
  }
};

template <class Payload>
bool send_payload(dds_entity_t writer, const Mark& mark) {
  static Payload sample = [] {
    Payload filled{};
    filled.module_id = 1;
    fill(filled.values);
    return filled;
  }();
  sample.number = mark.sequence;
  sample.stamp_ns = mark.stamp_ns;
  return dds_write(writer, &sample) == DDS_RETCODE_OK;
}

template <class Payload>
void take_payloads(dds_entity_t reader, Sink& sink) {
  constexpr int at_once = 16;
  void* samples[at_once] = {nullptr};  // null: on loan
  dds_sample_info_t infos[at_once];
  const dds_return_t taken = dds_take(reader, samples, infos, at_once, at_once);
  for (dds_return_t k = 0; k < taken; ++k) {
    if (!infos[k].valid_data) continue;
    const auto* sample = static_cast<const Payload*>(samples[k]);
    sink.arrived({sample->number, sample->stamp_ns}, is_filled(sample->values));
  }
  if (taken > 0) dds_return_loan(reader, samples, taken);
}

class CycloneTransport final : public Transport {
 public:
  CycloneTransport(const PeerOptions& options, Sink& sink) : options_(options), sink_(sink) {
    std::vector<const char*> peers;
    for (const std::string& peer : options.peers) peers.push_back(peer.c_str());
    const eciton_participant_config config{.domain = options.domain,
                                           .name = options.role == Role::ping ? "bench_ping" : "bench_echo",
                                           .network_interface = options.network_interface.c_str(),
                                           .peers = peers.data(),
                                           .peer_count = static_cast<std::uint32_t>(peers.size()),
                                           .lease_ms = 3000};
    participant_.reset(value_or_throw(eciton_participant::create(config)));
    waitset_ = good(dds_create_waitset(entity()), "waitset");
    guard_ = good(dds_create_guardcondition(entity()), "guard condition");
    dds_waitset_attach(waitset_, guard_, guard_);
    lanes_ = {lane<eciton_bench_Payload64>(eciton_bench_Payload64_desc, 64),
              lane<eciton_bench_Payload256>(eciton_bench_Payload256_desc, 256),
              lane<eciton_bench_Payload1024>(eciton_bench_Payload1024_desc, 1024),
              lane<eciton_bench_Payload4096>(eciton_bench_Payload4096_desc, 4096)};
    lane_ = &lanes_[0];
    if (options.delivery == Delivery::inlined) listen();
  }

  bool matched() override {
    return std::all_of(lanes_.begin(), lanes_.end(), [](const Lane& lane) { return lane.matched(); });
  }
  void select(std::uint32_t bytes) override {
    const auto found = std::find(payload_sizes.begin(), payload_sizes.end(), bytes);
    if (found == payload_sizes.end()) return;
    if (lane_->condition > 0) dds_waitset_detach(waitset_, lane_->condition);
    lane_ = &lanes_[found - payload_sizes.begin()];
    if (options_.delivery == Delivery::inlined) return;
    if (lane_->condition == 0) lane_->condition = dds_create_readcondition(lane_->reader, DDS_ANY_STATE);
    dds_waitset_attach(waitset_, lane_->condition, lane_->condition);
  }
  bool send(const Mark& mark) noexcept override { return lane_->send(lane_->writer, mark); }
  void wait_until(std::int64_t monotonic_ns) noexcept override {
    const std::int64_t left_ns = std::max<std::int64_t>(monotonic_ns - monotonic_now().count(), 0);
    dds_attach_t triggered[2];
    const dds_return_t count = dds_waitset_wait(waitset_, triggered, 2, left_ns);
    for (dds_return_t k = 0; k < std::min(count, 2); ++k) {
      if (triggered[k] == guard_) {
        bool was = false;
        dds_take_guardcondition(guard_, &was);
      } else {
        lane_->take(lane_->reader, sink_);
      }
    }
  }
  void interrupt() noexcept override { dds_set_guardcondition(guard_, true); }

 private:
  dds_entity_t entity() const { return participant_->participant.get(); }

  template <class Payload>
  Lane lane(const dds_topic_descriptor_t& type, std::uint32_t bytes) {
    const auto topic = [&](Role writer) {
      const std::string name = topic_name(options_, writer, bytes);
      return good(dds_create_topic(entity(), &type, name.c_str(), nullptr, nullptr), "topic");
    };
    const Qos qos = make_qos(options_);
    Lane made;
    made.writer = good(dds_create_writer(entity(), topic(options_.role), qos.get(), nullptr), "writer");
    made.reader = good(dds_create_reader(entity(), topic(other(options_.role)), qos.get(), nullptr), "reader");
    made.send = &send_payload<Payload>;
    made.take = &take_payloads<Payload>;
    return made;
  }

  void listen() {
    dds_listener_t* listener = dds_create_listener(this);
    dds_lset_data_available(listener, [](dds_entity_t reader, void* self) {
      auto& transport = *static_cast<CycloneTransport*>(self);
      for (const Lane& each : transport.lanes_) {
        if (each.reader == reader) each.take(reader, transport.sink_);
      }
    });
    for (const Lane& each : lanes_) dds_set_listener(each.reader, listener);
    dds_delete_listener(listener);
  }

  PeerOptions options_;
  Sink& sink_;
  std::unique_ptr<eciton_participant> participant_;
  dds_entity_t waitset_ = 0, guard_ = 0;
  std::array<Lane, payload_sizes.size()> lanes_;
  Lane* lane_ = nullptr;
};

std::unique_ptr<Transport> make(const PeerOptions& options, Sink& sink) {
  return std::make_unique<CycloneTransport>(options, sink);
}

}  // namespace
}  // namespace eciton::bench

int main(int argc, char** argv) { return eciton::bench::peer_main(argc, argv, eciton::bench::make); }

// Ours: a participant, writers and readers of the framework. wake: waiting as the real-time executor does. inline:
// the readers that call back in the vendor's thread.
#include "benchmarks/idl/payload.hpp"
#include "benchmarks/latency/peers/transport.hpp"
#include "core/base/wall_clock.hpp"
#include "core/bus/inline_reader.hpp"
#include "core/bus/participant.hpp"
#include "core/runtime/sleeper.hpp"

namespace eciton::bench {
namespace {

using bus::QosClass;

/// The two topics of one payload size.
class Lane {
 public:
  virtual ~Lane() = default;
  virtual bool matched() const = 0;
  virtual bool send(const Mark& mark) noexcept = 0;
  virtual void take() noexcept = 0;
};

template <class Payload>
class LaneOf final : public Lane {
 public:
  LaneOf(bus::Participant& participant, const PeerOptions& options, Sink& sink)
      : sink_(sink), writer_(participant.create_writer(topic(topic_name(options, options.role, bytes), options))) {
    sample_.module_id = 1;
    fill(sample_.values);
    const std::string name = topic_name(options, other(options.role), bytes);
    if (options.delivery == Delivery::wake) {
      reader_.emplace(participant.create_reader(topic(name, options)));
    } else {
      inline_reader_.emplace(participant.create_inline_reader(topic(name, options), &LaneOf::on_sample, this));
    }
  }

  bool matched() const override {
    return writer_.matched() > 0 && (reader_ ? reader_->matched() : inline_reader_->matched()) > 0;
  }
  bool send(const Mark& mark) noexcept override {
    sample_.number = mark.sequence;
    sample_.stamp_ns = mark.stamp_ns;
    return writer_.write(sample_);
  }
  void take() noexcept override {
    while (const auto sample = reader_->take()) on_sample(this, sample->value);
  }

 private:
  static bus::Topic<Payload> topic(const std::string& name, const PeerOptions& options) {
    return {name, options.reliable ? QosClass::command : QosClass::sensor, bus::Scope::module};
  }
  static void on_sample(void* self, const Payload& sample) {
    static_cast<LaneOf*>(self)->sink_.arrived({sample.number, sample.stamp_ns}, is_filled(sample.values));
  }
  static constexpr std::uint32_t bytes = 16 + sizeof(Payload::values);

  Sink& sink_;
  Payload sample_{};
  bus::Writer<Payload> writer_;
  std::optional<bus::Reader<Payload>> reader_;
  std::optional<bus::InlineReader<Payload>> inline_reader_;
};

class EcitonTransport final : public Transport {
 public:
  EcitonTransport(const PeerOptions& options, Sink& sink)
      : participant_(config(options)), sleeper_(participant_.waker(), never_) {
    lanes_[0] = std::make_unique<LaneOf<Payload64>>(participant_, options, sink);
    lanes_[1] = std::make_unique<LaneOf<Payload256>>(participant_, options, sink);
    lanes_[2] = std::make_unique<LaneOf<Payload1024>>(participant_, options, sink);
    lanes_[3] = std::make_unique<LaneOf<Payload4096>>(participant_, options, sink);
    lane_ = lanes_[0].get();
  }

  bool matched() override {
    return std::all_of(lanes_.begin(), lanes_.end(), [](const auto& lane) { return lane->matched(); });
  }
  void select(std::uint32_t bytes) override {
    const auto found = std::find(payload_sizes.begin(), payload_sizes.end(), bytes);
    if (found != payload_sizes.end()) lane_ = lanes_[found - payload_sizes.begin()].get();
  }
  bool send(const Mark& mark) noexcept override { return lane_->send(mark); }
  void wait_until(std::int64_t monotonic_ns) noexcept override {
    sleeper_.until(Duration{monotonic_ns});
    participant_.set_now(wall_now());
    lane_->take();
  }
  void interrupt() noexcept override { participant_.waker().signal(); }

 private:
  static bus::ParticipantConfig config(const PeerOptions& options) {
    return {.vendor = options.vendor,
            .domain = options.domain,
            .name = options.role == Role::ping ? "bench_ping" : "bench_echo",
            .network_interface = options.network_interface,
            .peers = options.peers};
  }

  bus::Participant participant_;
  runtime::StopFlag never_;
  runtime::Sleeper sleeper_;
  std::array<std::unique_ptr<Lane>, payload_sizes.size()> lanes_;
  Lane* lane_;
};

std::unique_ptr<Transport> make(const PeerOptions& options, Sink& sink) {
  return std::make_unique<EcitonTransport>(options, sink);
}

}  // namespace
}  // namespace eciton::bench

int main(int argc, char** argv) { return eciton::bench::peer_main(argc, argv, eciton::bench::make); }

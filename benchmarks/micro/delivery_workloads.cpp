// A 256 B sample from a writer to a reader: the framework's part of it over a vendor that does next to
// nothing, and the whole of it over sim_network in one process.
#include <memory>
#include <vector>

#include "benchmarks/idl/payload.hpp"
#include "benchmarks/micro/workload.hpp"
#include "core/bus/inline_reader.hpp"
#include "core/bus/reader.hpp"
#include "core/bus/writer.hpp"

namespace eciton::bench {
namespace {

constexpr bus::Topic<Payload256> topic{"payload", bus::QosClass::sensor, bus::Scope::module};

bus::ParticipantConfig config(const char* vendor, std::uint32_t domain, const char* name) {
  bus::ParticipantConfig out;
  out.name = name;
  out.vendor = vendor;
  out.domain = domain;
  return out;
}

/// Two participants, as two services that do not share one; nobody sleeps, so nobody is woken.
struct Pair {
  Pair(const char* vendor, std::uint32_t domain)
      : sender(config(vendor, domain, "sender")),
        receiver(config(vendor, domain, "receiver")),
        writer(sender.create_writer(topic)) {
    receiver.set_all_wake(false);
  }
  bus::Participant sender, receiver;
  bus::Writer<Payload256> writer;
  Payload256 sample{.module_id = 1};
};

struct WithReader : Pair {
  WithReader(const char* vendor, std::uint32_t domain)
      : Pair(vendor, domain), reader(receiver.create_reader(topic)), raw(sender.create_raw_writer(info(topic))) {
    bytes.resize(bus::TypeTraits<Payload256>::size_max);
    bytes.resize(bus::encode(sample, bytes));
  }
  double take() {
    const auto got = reader.take();
    return got ? static_cast<double>(got->value.stamp_ns) : -1;
  }
  bus::Reader<Payload256> reader;
  bus::RawWriter raw;
  std::vector<std::uint8_t> bytes;
};

Step write_only() {
  auto pair = std::make_shared<Pair>("mirror", 1);
  return [pair] { return pair->writer.write(pair->sample) ? 1.0 : -1.0; };
}

/// The bytes are ready made: what is handed over to the reader is a copy of them.
Step take_only() {
  auto pair = std::make_shared<WithReader>("mirror", 2);
  return [pair] {
    pair->raw.write(pair->bytes);
    return pair->take();
  };
}

/// The reader is called back within the write.
Step deliver_inline() {
  struct Inline : Pair {
    using Pair::Pair;
    std::int64_t stamp_ns = 0;
    bus::RawWriter raw = sender.create_raw_writer(info(topic));
    bus::InlineReader<Payload256> reader{
        receiver, topic,
        [](void* self, const Payload256& got) { static_cast<Inline*>(self)->stamp_ns = got.stamp_ns; }, this};
  };
  auto pair = std::make_shared<Inline>("mirror", 4);
  std::vector<std::uint8_t> bytes(bus::TypeTraits<Payload256>::size_max);
  bytes.resize(bus::encode(pair->sample, bytes));
  return [pair, bytes] { return pair->raw.write(bytes) ? static_cast<double>(pair->stamp_ns) : -1; };
}

Step write_and_take(const char* vendor, std::uint32_t domain) {
  auto pair = std::make_shared<WithReader>(vendor, domain);
  return [pair] {
    ++pair->sample.stamp_ns;
    pair->writer.write(pair->sample);
    return pair->take();
  };
}

}  // namespace

std::vector<Workload> delivery_workloads() {
  return {{"framework/serialize_and_hand_over", write_only, true},
          {"framework/take_and_deserialize", take_only, true},
          {"framework/deserialize_inline", deliver_inline, true},
          {"sim_network/write_to_take", [] { return write_and_take("sim_network", 3); }, true}};
}

}  // namespace eciton::bench

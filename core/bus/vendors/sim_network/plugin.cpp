// What the framework loads: the table of the plugin ABI, over the networks of this process. A handle stands for an
// object that the medium owns.
#include <string>

#include "core/bus/vendors/plugin_table.hpp"
#include "core/bus/vendors/sim_network/medium.hpp"

namespace sim = eciton::bus::sim_network;

namespace {

/// The handle of what `create(message)` gives, or that message.
template <class Handle, class Create>
eciton::Result<Handle*> handle_of(Create&& create) {
  std::string message;
  auto* created = create(message);
  if (created == nullptr) return eciton::Error{message};
  return new Handle{*created};
}

sim::Medium& medium_of(const sim::Endpoint& endpoint) { return *endpoint.participant.medium; }

}  // namespace

struct eciton_participant {
  static eciton::Result<eciton_participant*> create(const eciton_participant_config& config) {
    return handle_of<eciton_participant>([&](std::string& message) {
      return sim::Network::of(config.domain).medium().create_participant(config.name, message);
    });
  }
  explicit eciton_participant(sim::Participant& of) : self(of) {}
  ~eciton_participant() { self.medium->destroy(self); }

  sim::Participant& self;
};

struct eciton_writer {
  static eciton::Result<eciton_writer*> create(eciton_participant& participant, const char* topic,
                                               const eciton_type& type, const eciton_qos& qos) {
    return handle_of<eciton_writer>([&](std::string& message) {
      return participant.self.medium->create_writer(participant.self, topic, type, qos, message);
    });
  }
  explicit eciton_writer(sim::Writer& of) : self(of) {}
  ~eciton_writer() { medium_of(self).destroy(self); }

  bool write(const std::uint8_t* cdr, std::uint32_t size) { return medium_of(self).write(self, {cdr, size}); }
  std::uint32_t matched() const { return medium_of(self).matched(self); }

  sim::Writer& self;
};

struct eciton_reader {
  static eciton::Result<eciton_reader*> create(eciton_participant& participant, const char* topic,
                                               const eciton_type& type, const eciton_qos& qos,
                                               eciton_delivery delivery) {
    return handle_of<eciton_reader>([&](std::string& message) {
      return participant.self.medium->create_reader(participant.self, topic, type, qos, delivery, message);
    });
  }
  explicit eciton_reader(sim::Reader& of) : self(of) {}
  ~eciton_reader() { medium_of(self).destroy(self); }

  std::uint32_t take(std::uint32_t count_max, eciton_sink sink, void* context) {
    return medium_of(self).take(self, count_max, sink, context);
  }
  std::uint32_t matched() const { return medium_of(self).matched(self); }
  eciton_reader_losses losses() const { return medium_of(self).losses(self); }
  std::uint64_t origin() const { return self.origin; }

  sim::Reader& self;
};

namespace {

constexpr eciton_plugin plugin = eciton::bus::vendors::plugin_table("sim_network", "1.0.0");

}  // namespace

extern "C" [[gnu::visibility("default")]] const eciton_plugin* eciton_dds_plugin(void) { return &plugin; }

// The C ABI of core/bus/plugin.h over the networks of this process.
#include "core/bus/plugin.h"

#include <cstdio>
#include <exception>
#include <string>

#include "core/bus/vendors/sim_network/medium.hpp"

namespace eciton::bus::sim_network {
namespace {

// The ABI's handles are these objects.
Participant& of(eciton_participant* handle) { return *reinterpret_cast<Participant*>(handle); }
Writer& of(eciton_writer* handle) { return *reinterpret_cast<Writer*>(handle); }
Reader& of(eciton_reader* handle) { return *reinterpret_cast<Reader*>(handle); }
Medium& medium_of(const Endpoint& endpoint) { return *endpoint.participant.medium; }

/// Runs `create(message)`; no exception crosses the ABI.
template <class Handle, class Create>
Handle* guarded(char* error, std::uint32_t error_size, Create&& create) {
  std::string message;
  void* created = nullptr;
  try {
    created = create(message);
  } catch (const std::exception& thrown) {
    message = std::string("sim_network: ") + thrown.what();
  }
  if (!created && error && error_size > 0) std::snprintf(error, error_size, "%s", message.c_str());
  return static_cast<Handle*>(created);
}

eciton_participant* participant_create(const eciton_participant_config* config, char* error,
                                       std::uint32_t error_size) {
  return guarded<eciton_participant>(error, error_size, [config](std::string& message) {
    return Network::of(config->domain).medium().create_participant(config->name, message);
  });
}

void participant_destroy(eciton_participant* handle) { of(handle).medium->destroy(of(handle)); }

eciton_writer* writer_create(eciton_participant* handle, const char* topic, const eciton_type* type,
                             const eciton_qos* qos, char* error, std::uint32_t error_size) {
  return guarded<eciton_writer>(error, error_size, [&](std::string& message) {
    return of(handle).medium->create_writer(of(handle), topic, *type, *qos, message);
  });
}

void writer_destroy(eciton_writer* handle) { medium_of(of(handle)).destroy(of(handle)); }

int writer_write(eciton_writer* handle, const std::uint8_t* cdr, std::uint32_t size) {
  return medium_of(of(handle)).write(of(handle), {cdr, size}) ? 1 : 0;
}

std::uint32_t writer_matched(eciton_writer* handle) { return medium_of(of(handle)).matched(of(handle)); }

eciton_reader* reader_create(eciton_participant* handle, const char* topic, const eciton_type* type,
                             const eciton_qos* qos, eciton_wake wake, char* error, std::uint32_t error_size) {
  return guarded<eciton_reader>(error, error_size, [&](std::string& message) {
    return of(handle).medium->create_reader(of(handle), topic, *type, *qos, wake, message);
  });
}

void reader_destroy(eciton_reader* handle) { medium_of(of(handle)).destroy(of(handle)); }

std::uint32_t reader_take(eciton_reader* handle, std::uint32_t count_max, eciton_sink sink, void* context) {
  return medium_of(of(handle)).take(of(handle), count_max, sink, context);
}

std::uint32_t reader_matched(eciton_reader* handle) { return medium_of(of(handle)).matched(of(handle)); }

constexpr eciton_plugin plugin = {
    .abi_version = ECITON_PLUGIN_ABI_VERSION,
    .struct_size = sizeof(eciton_plugin),
    .vendor = "sim_network",
    .version = "1.0.0",
    .participant_create = participant_create,
    .participant_destroy = participant_destroy,
    .writer_create = writer_create,
    .writer_destroy = writer_destroy,
    .writer_write = writer_write,
    .writer_matched = writer_matched,
    .reader_create = reader_create,
    .reader_destroy = reader_destroy,
    .reader_take = reader_take,
    .reader_matched = reader_matched,
};

}  // namespace
}  // namespace eciton::bus::sim_network

extern "C" [[gnu::visibility("default")]] const eciton_plugin* eciton_dds_plugin(void) {
  return &eciton::bus::sim_network::plugin;
}

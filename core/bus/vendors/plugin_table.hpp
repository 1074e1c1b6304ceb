// The plugin ABI over a vendor's handles: one function pointer per entry, no exception past it. The same for every
// vendor, who defines eciton_participant, eciton_writer and eciton_reader before asking for the table.
#pragma once

#include "core/bus/plugin.h"
#include "core/bus/vendors/request.hpp"

namespace eciton::bus::vendors {

template <class Participant = eciton_participant, class Writer = eciton_writer, class Reader = eciton_reader>
constexpr eciton_plugin plugin_table(const char* vendor, const char* version) {
  eciton_plugin table{};
  table.abi_version = ECITON_PLUGIN_ABI_VERSION;
  table.struct_size = sizeof(eciton_plugin);
  table.vendor = vendor;
  table.version = version;

  table.participant_create = [](const eciton_participant_config* config, char* error, std::uint32_t error_size) {
    return created_or_null<Participant>(error, error_size, [&] { return Participant::create(*config); });
  };
  table.participant_destroy = [](Participant* participant) { delete participant; };

  table.writer_create = [](Participant* participant, const char* topic, const eciton_type* type,
                           const eciton_qos* qos, char* error, std::uint32_t error_size) {
    return created_or_null<Writer>(error, error_size,
                                   [&] { return Writer::create(*participant, topic, *type, *qos); });
  };
  table.writer_destroy = [](Writer* writer) { delete writer; };
  table.writer_write = [](Writer* writer, const std::uint8_t* cdr, std::uint32_t size) {
    return writer->write(cdr, size) ? 1 : 0;
  };
  table.writer_matched = [](Writer* writer) { return writer->matched(); };

  table.reader_create = [](Participant* participant, const char* topic, const eciton_type* type,
                           const eciton_qos* qos, eciton_delivery delivery, char* error, std::uint32_t error_size) {
    return created_or_null<Reader>(error, error_size,
                                   [&] { return Reader::create(*participant, topic, *type, *qos, delivery); });
  };
  table.reader_destroy = [](Reader* reader) { delete reader; };
  table.reader_take = [](Reader* reader, std::uint32_t count_max, eciton_sink sink, void* context) {
    return reader->take(count_max, sink, context);
  };
  table.reader_matched = [](Reader* reader) { return reader->matched(); };
  table.reader_losses = [](Reader* reader, eciton_reader_losses* losses) { *losses = reader->losses(); };
  table.reader_origin = [](Reader* reader) { return reader->origin(); };
  return table;
}

}  // namespace eciton::bus::vendors

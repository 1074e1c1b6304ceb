// The plugin ABI on Fast DDS: one function pointer per entry, no exception past it.
#include "core/bus/plugin.h"

#include <fastrtps/config.h>

#include "core/bus/vendors/fastdds/endpoints.hpp"
#include "core/bus/vendors/fastdds/participant.hpp"
#include "core/bus/vendors/request.hpp"

using eciton::bus::vendors::created_or_null;

namespace {

eciton_participant* participant_create(const eciton_participant_config* config, char* error,
                                       std::uint32_t error_size) {
  return created_or_null<eciton_participant>(error, error_size, [&] { return eciton_participant::create(*config); });
}

void participant_destroy(eciton_participant* participant) { delete participant; }

eciton_writer* writer_create(eciton_participant* participant, const char* topic, const eciton_type* type,
                             const eciton_qos* qos, char* error, std::uint32_t error_size) {
  return created_or_null<eciton_writer>(error, error_size,
                                        [&] { return eciton_writer::create(*participant, topic, *type, *qos); });
}

void writer_destroy(eciton_writer* writer) { delete writer; }

int writer_write(eciton_writer* writer, const std::uint8_t* cdr, std::uint32_t size) {
  return writer->write(cdr, size) ? 1 : 0;
}

std::uint32_t writer_matched(eciton_writer* writer) { return writer->matched(); }

eciton_reader* reader_create(eciton_participant* participant, const char* topic, const eciton_type* type,
                             const eciton_qos* qos, eciton_wake wake, char* error, std::uint32_t error_size) {
  return created_or_null<eciton_reader>(
      error, error_size, [&] { return eciton_reader::create(*participant, topic, *type, *qos, wake); });
}

void reader_destroy(eciton_reader* reader) { delete reader; }

std::uint32_t reader_take(eciton_reader* reader, std::uint32_t count_max, eciton_sink sink, void* context) {
  return reader->take(count_max, sink, context);
}

std::uint32_t reader_matched(eciton_reader* reader) { return reader->matched(); }

constexpr eciton_plugin kPlugin = {
    ECITON_PLUGIN_ABI_VERSION,
    sizeof(eciton_plugin),
    "fastdds",
    FASTRTPS_VERSION_STR,
    participant_create,
    participant_destroy,
    writer_create,
    writer_destroy,
    writer_write,
    writer_matched,
    reader_create,
    reader_destroy,
    reader_take,
    reader_matched,
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const eciton_plugin* eciton_dds_plugin(void) { return &kPlugin; }

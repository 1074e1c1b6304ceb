// A plugin that carries nothing anywhere: it keeps the last sample for the one reader, so that what is left of a
// write and a take is the framework's own code.
#include <cstring>

#include "core/bus/plugin.h"

struct eciton_participant {};
struct eciton_writer {};
struct eciton_reader {
  eciton_delivery delivery;
  bool full;
  uint32_t size;
  uint8_t bytes[8192];
};

namespace {

eciton_reader* the_reader = nullptr;

int write(eciton_writer*, const uint8_t* cdr, uint32_t size) {
  eciton_reader* const reader = the_reader;
  if (reader == nullptr || size > sizeof reader->bytes) return 1;
  std::memcpy(reader->bytes, cdr, size);
  reader->size = size;
  reader->full = true;
  reader->delivery.signal(reader->delivery.context);
  return 1;
}

uint32_t take(eciton_reader* reader, uint32_t, eciton_sink sink, void* context) {
  if (!reader->full) return 0;
  reader->full = false;
  sink(context, reader->bytes, reader->size);
  return 1;
}

const eciton_plugin plugin = [] {
  eciton_plugin made{};
  made.abi_version = ECITON_PLUGIN_ABI_VERSION;
  made.struct_size = sizeof made;
  made.vendor = "nothing";
  made.version = "1";
  made.participant_create = [](const eciton_participant_config*, char*, uint32_t) { return new eciton_participant; };
  made.participant_destroy = [](eciton_participant* participant) { delete participant; };
  made.writer_create = [](eciton_participant*, const char*, const eciton_type*, const eciton_qos*, char*, uint32_t) {
    return new eciton_writer;
  };
  made.writer_destroy = [](eciton_writer* writer) { delete writer; };
  made.writer_write = write;
  made.writer_matched = [](eciton_writer*) { return 1u; };
  made.reader_create = [](eciton_participant*, const char*, const eciton_type*, const eciton_qos*,
                          eciton_delivery delivery, char*, uint32_t) {
    return the_reader = new eciton_reader{delivery, false, 0, {}};
  };
  made.reader_destroy = [](eciton_reader* reader) {
    the_reader = nullptr;
    delete reader;
  };
  made.reader_take = take;
  made.reader_matched = [](eciton_reader*) { return 1u; };
  made.reader_losses = [](eciton_reader*, eciton_reader_losses* losses) { *losses = {}; };
  made.reader_origin = [](eciton_reader*) -> uint64_t { return 0; };
  return made;
}();

}  // namespace

extern "C" __attribute__((visibility("default"))) const eciton_plugin* eciton_dds_plugin(void) { return &plugin; }

// The least that a DDS vendor could do: a writer's bytes are there for the readers of its topic at once, the
// newest only. What is measured over it is the framework's own work.
#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "core/bus/plugin.h"

struct eciton_participant {};

struct eciton_reader {
  eciton_participant* participant;
  std::string topic;
  eciton_delivery delivery;
  std::array<std::uint8_t, 8192> bytes{};
  std::uint32_t size = 0;
};

struct eciton_writer {
  eciton_participant* participant;
  std::string topic;
};

namespace {

std::vector<eciton_reader*>& readers() {
  static std::vector<eciton_reader*> all;
  return all;
}

eciton_participant* participant_create(const eciton_participant_config*, char*, std::uint32_t) {
  return new eciton_participant;
}
void participant_destroy(eciton_participant* participant) { delete participant; }

eciton_writer* writer_create(eciton_participant* participant, const char* topic, const eciton_type*,
                             const eciton_qos*, char*, std::uint32_t) {
  return new eciton_writer{participant, topic};
}
void writer_destroy(eciton_writer* writer) { delete writer; }

int writer_write(eciton_writer* writer, const std::uint8_t* cdr, std::uint32_t size) {
  for (eciton_reader* reader : readers()) {
    if (reader->participant == writer->participant || reader->topic != writer->topic) continue;
    if (reader->delivery.sample != nullptr) {
      reader->delivery.sample(reader->delivery.context, cdr, size);
      continue;
    }
    reader->size = std::min(size, static_cast<std::uint32_t>(reader->bytes.size()));
    std::memcpy(reader->bytes.data(), cdr, reader->size);
    reader->delivery.signal(reader->delivery.context);
  }
  return 1;
}

eciton_reader* reader_create(eciton_participant* participant, const char* topic, const eciton_type*,
                             const eciton_qos*, eciton_delivery delivery, char*, std::uint32_t) {
  auto* reader = new eciton_reader{.participant = participant, .topic = topic, .delivery = delivery};
  readers().push_back(reader);
  return reader;
}
void reader_destroy(eciton_reader* reader) {
  std::erase(readers(), reader);
  delete reader;
}

std::uint32_t reader_take(eciton_reader* reader, std::uint32_t, eciton_sink sink, void* context) {
  if (reader->size == 0) return 0;
  sink(context, reader->bytes.data(), reader->size);
  reader->size = 0;
  return 1;
}

std::uint32_t writer_matched(eciton_writer*) { return 1; }
std::uint32_t reader_matched(eciton_reader*) { return 1; }
void reader_losses(eciton_reader*, eciton_reader_losses* losses) { *losses = {}; }

std::uint64_t reader_origin(eciton_reader*) { return 0; }

}  // namespace

extern "C" const eciton_plugin* eciton_dds_plugin(void) {
  static const eciton_plugin plugin{ECITON_PLUGIN_ABI_VERSION,
                                    sizeof(eciton_plugin),
                                    "mirror",
                                    "1",
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
                                    reader_losses,
                                    reader_origin};
  return &plugin;
}

// Writer and reader of Cyclone DDS: one copy of the bytes into the pool at write and one at receipt, none in take.
#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>

#include "core/bus/vendors/cyclonedds/bytes_type.hpp"
#include "core/bus/vendors/cyclonedds/entities.hpp"
#include "core/bus/vendors/cyclonedds/qos.hpp"
#include "core/bus/vendors/request.hpp"

using eciton::Error;
using eciton::Result;
using eciton::bus::cyclonedds::BytesPool;
using eciton::bus::cyclonedds::BytesSerdata;

namespace eciton::bus::cyclonedds {
namespace {

// Samples on their way beyond those a history holds: being sent, received, taken or retransmitted.
constexpr std::size_t kSamplesInFlight = 24;
// Reserved for one endpoint at most. Only events (64 of each key) can need more, and they are not for control: the
// pool then grows as they come.
constexpr std::size_t kSamplesReservedMax = 128;
// A take hands out this many samples at a time.
constexpr std::uint32_t kTakenAtOnce = 16;

struct CreatedTopic {
  dds_entity_t topic;
  const ddsi_sertype* registered;  // lives as long as the topic
};

Result<CreatedTopic> create_topic(const eciton_participant& participant, const char* name, const eciton_type& type) {
  ddsi_sertype* sertype = new_bytes_sertype(type);
  const dds_entity_t topic =
      dds_create_topic_sertype(participant.participant.get(), name, &sertype, nullptr, nullptr, nullptr);
  if (topic > 0) return CreatedTopic{topic, sertype};
  ddsi_sertype_unref(sertype);
  return Error{participant.label() + ": Cyclone DDS cannot create topic \"" + name + "\" of type " + type.name +
               ": " + dds_strretcode(-topic)};
}

Error cannot_create(const eciton_participant& participant, const char* what, const char* topic, dds_entity_t code) {
  return Error{participant.label() + ": Cyclone DDS cannot create a " + what + " of topic \"" + topic +
               "\": " + dds_strretcode(-code)};
}

Error no_memory(const eciton_participant& participant, const char* topic, const eciton_qos& qos) {
  return Error{participant.label() + ": no memory for topic \"" + topic + "\" (depth " + std::to_string(qos.depth) +
               ", " + std::to_string(qos.instances_max) + " keys): all endpoints of a process share " +
               std::to_string(BytesPool::kBytesMax >> 20) + " MiB"};
}

}  // namespace

bool Reservation::acquire(const eciton_type& type, const eciton_qos& qos) {
  BytesPool& pool = BytesPool::instance();
  const std::size_t sample_size = sample_block_size(type);
  const std::size_t held = std::min<std::size_t>(std::size_t{qos.depth} * qos.instances_max, kSamplesReservedMax);
  const std::size_t samples = held + kSamplesInFlight;
  if (!pool.reserve(sample_size, samples)) return false;
  sample_size_ = sample_size;
  samples_ = samples;
  if (!pool.reserve(kKeyBlockSize, qos.instances_max)) return false;
  keys_ = qos.instances_max;
  return true;
}

Reservation::~Reservation() {
  if (samples_ > 0) BytesPool::instance().unreserve(sample_size_, samples_);
  if (keys_ > 0) BytesPool::instance().unreserve(kKeyBlockSize, keys_);
}

}  // namespace eciton::bus::cyclonedds

namespace cyclonedds = eciton::bus::cyclonedds;

Result<eciton_writer*> eciton_writer::create(eciton_participant& participant, const char* topic,
                                             const eciton_type& type, const eciton_qos& qos) {
  if (const eciton::Status checked = eciton::bus::vendors::check_endpoint(topic, type, qos); !checked) {
    return checked.error();
  }
  std::unique_ptr<eciton_writer> created(new eciton_writer(type, qos));
  if (!created->memory_.acquire(type, qos)) return cyclonedds::no_memory(participant, topic, qos);
  const auto on = cyclonedds::create_topic(participant, topic, type);
  if (!on) return on.error();
  created->topic_.reset(on->topic);
  const dds_entity_t writer = [&] {
    const cyclonedds::WithoutKeyHashes lean(*on->registered);
    const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(dds_create_listener(created.get()),
                                                                              dds_delete_listener);
    dds_lset_publication_matched(listener.get(), &eciton_writer::on_matched);
    return dds_create_writer(participant.participant.get(), on->topic, cyclonedds::make_qos(qos).get(),
                             listener.get());
  }();
  if (writer < 0) return cyclonedds::cannot_create(participant, "writer", topic, writer);
  created->writer_.reset(writer);
  return created.release();
}

bool eciton_writer::write(const std::uint8_t* cdr, std::uint32_t size) {
  if (!eciton::bus::vendors::well_formed(type_, cdr, size)) return false;
  eciton::bus::vendors::InstanceKey key;
  if (!eciton::bus::vendors::key_hash_of(type_, cdr, size, false, key.data())) return false;
  {
    const std::lock_guard<cyclonedds::InheritingMutex> lock(keys_mutex_);
    if (!keys_.admit(key)) return false;
  }
  if (keeps_nothing_ && matched() == 0) return true;
  const cyclonedds::Bytes bytes{cdr, size};
  return dds_write(writer_.get(), &bytes) == DDS_RETCODE_OK;
}

void eciton_writer::on_matched(dds_entity_t, const dds_publication_matched_status_t status, void* self) {
  static_cast<eciton_writer*>(self)->matched_.store(status.current_count, std::memory_order_relaxed);
}

Result<eciton_reader*> eciton_reader::create(eciton_participant& participant, const char* topic,
                                             const eciton_type& type, const eciton_qos& qos,
                                             eciton_delivery delivery) {
  if (const eciton::Status checked = eciton::bus::vendors::check_endpoint(topic, type, qos); !checked) {
    return checked.error();
  }
  std::unique_ptr<eciton_reader> created(new eciton_reader(type, qos, delivery));
  if (!created->memory_.acquire(type, qos)) return cyclonedds::no_memory(participant, topic, qos);
  const auto on = cyclonedds::create_topic(participant, topic, type);
  if (!on) return on.error();
  created->topic_.reset(on->topic);
  // Not by RESOURCE_LIMITS: a reliable reader that refuses a sample for want of instances has it offered again and
  // again by the receive thread, which delivers nothing else meanwhile. A filtered sample is gone.
  dds_topic_filter filter{};
  filter.mode = DDS_TOPIC_FILTER_SAMPLE_ARG;
  filter.f.sample_arg = &eciton_reader::admit;
  filter.arg = created.get();
  dds_set_topic_filter_extended(on->topic, &filter);
  const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(dds_create_listener(created.get()),
                                                                            dds_delete_listener);
  dds_lset_data_available(listener.get(), &eciton_reader::on_data_available);
  const dds_entity_t reader =
      dds_create_reader(participant.participant.get(), on->topic, cyclonedds::make_qos(qos).get(), listener.get());
  if (reader < 0) return cyclonedds::cannot_create(participant, "reader", topic, reader);
  created->reader_.reset(reader);
  return created.release();
}

bool eciton_reader::admit(const void* sample, void* self) {
  auto& reader = *static_cast<eciton_reader*>(self);
  const auto* bytes = static_cast<const cyclonedds::Bytes*>(sample);
  if (bytes->origin != nullptr) {
    reader.gaps_.observe(bytes->origin->writer, bytes->origin->number);
    reader.missing_.store(reader.gaps_.missing(), std::memory_order_relaxed);
  }
  eciton::bus::vendors::InstanceKey key;
  const bool good = eciton::bus::vendors::key_hash_of(reader.type_, bytes->cdr, bytes->size, false, key.data()) &&
                    reader.keys_.admit(key);
  (good ? reader.admitted_ : reader.rejected_).fetch_add(1, std::memory_order_relaxed);
  return good;
}

// The first call may come before dds_create_reader has returned: hence its own handle.
void eciton_reader::on_data_available(dds_entity_t handle, void* self) {
  auto& reader = *static_cast<eciton_reader*>(self);
  const eciton_delivery& delivery = reader.delivery_;
  if (delivery.sample != nullptr) {
    reader.take_from(handle, std::numeric_limits<std::uint32_t>::max(), delivery.sample, delivery.context);
  } else if (delivery.signal != nullptr) {
    delivery.signal(delivery.context);
  }
}

std::uint32_t eciton_reader::take(std::uint32_t count_max, eciton_sink sink, void* context) {
  return take_from(reader_.get(), count_max, sink, context);
}

std::uint32_t eciton_reader::take_from(dds_entity_t reader, std::uint32_t count_max, eciton_sink sink,
                                       void* context) {
  // Once nothing is left, what was admitted before and not given has been replaced.
  const std::uint64_t admitted = admitted_.load(std::memory_order_acquire);
  std::uint32_t given = 0;
  ddsi_serdata* samples[cyclonedds::kTakenAtOnce];
  dds_sample_info_t infos[cyclonedds::kTakenAtOnce];
  while (given < count_max) {
    const std::uint32_t asked = std::min(cyclonedds::kTakenAtOnce, count_max - given);
    const dds_return_t taken = dds_takecdr(reader, samples, asked, infos, DDS_ANY_STATE);
    if (taken <= 0) {
      if (admitted > given_ + replaced_.load(std::memory_order_relaxed)) {
        replaced_.store(admitted - given_, std::memory_order_relaxed);
      }
      break;
    }
    for (dds_return_t k = 0; k < taken; ++k) {
      const auto* bytes = static_cast<const BytesSerdata*>(samples[k]);
      if (infos[k].valid_data) {  // not: a writer went or disposed; the framework tells by fields and ages
        origin_ = eciton::bus::vendors::origin_of(bytes->origin.writer);
        sink(context, bytes->cdr(), bytes->size);
        ++given;
        ++given_;
      }
      ddsi_serdata_unref(samples[k]);
    }
  }
  return given;
}

std::uint32_t eciton_reader::matched() const {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader_.get(), &status);
  return status.current_count;
}

// Of what does not even have the shape of a sample the vendor makes none: it is not counted here.
eciton_reader_losses eciton_reader::losses() const {
  const std::uint64_t missing = missing_.load(std::memory_order_relaxed);
  // A reliable writer leaves out what was replaced in its history; to a late joiner of one that keeps samples, its
  // past.
  const bool superseded = reliable_ && !keeps_past_;
  return {.lost = reliable_ ? 0 : missing,
          .rejected = rejected_.load(std::memory_order_relaxed),
          .replaced = replaced_.load(std::memory_order_relaxed) + (superseded ? missing : 0)};
}

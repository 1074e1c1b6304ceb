// Reads bytes with Fast DDS: samples are taken on loan, so the sink sees the vendor's own buffer, unlocked.
#include <algorithm>
#include <fastdds/dds/core/LoanableSequence.hpp>
#include <limits>

#include "core/bus/vendors/fastdds/bytes_type.hpp"
#include "core/bus/vendors/fastdds/endpoints.hpp"
#include "core/bus/vendors/fastdds/qos.hpp"
#include "core/bus/vendors/request.hpp"

namespace fast = eprosima::fastdds::dds;
using eciton::Error;
using eciton::Result;
using eciton::bus::fastdds::Bytes;
using eciton::bus::fastdds::kLoansMax;

namespace {

FASTDDS_SEQUENCE(BytesSeq, Bytes);

eciton::bus::vendors::WriterGuid guid_of(const eprosima::fastrtps::rtps::SampleIdentity& sample) {
  eciton::bus::vendors::WriterGuid guid;
  std::copy_n(sample.writer_guid().guidPrefix.value, 12, guid.begin());
  std::copy_n(sample.writer_guid().entityId.value, 4, guid.begin() + 12);
  return guid;
}

}  // namespace

Result<eciton_reader*> eciton_reader::create(eciton_participant& participant, const char* topic,
                                             const eciton_type& type, const eciton_qos& qos,
                                             eciton_delivery delivery) {
  if (const eciton::Status checked = eciton::bus::vendors::check_endpoint(topic, type, qos); !checked) {
    return checked.error();
  }
  const Result<fast::Topic*> on = participant.topic(topic, type);
  if (!on) return on.error();
  std::unique_ptr<eciton_reader> created(new eciton_reader(participant, type, qos, delivery));
  created->reader_ = participant.subscriber->create_datareader(
      *on, eciton::bus::fastdds::reader_qos(qos), created.get(),
      fast::StatusMask::data_available() << fast::StatusMask::subscription_matched()
                                         << fast::StatusMask::sample_lost() << fast::StatusMask::sample_rejected());
  if (created->reader_ == nullptr) {
    return Error{participant.label() + ": Fast DDS cannot create a reader of topic \"" + topic + "\""};
  }
  return created.release();
}

eciton_reader::~eciton_reader() {
  // Deleting first detaches the listener under the lock its calls are made under: none comes later.
  if (reader_ != nullptr) participant_.subscriber->delete_datareader(reader_);
}

std::uint32_t eciton_reader::take(std::uint32_t count_max, eciton_sink sink, void* context) {
  return take_from(*reader_, count_max, sink, context);
}

std::uint32_t eciton_reader::take_from(fast::DataReader& reader, std::uint32_t count_max, eciton_sink sink,
                                       void* context) {
  std::uint32_t given = 0;
  while (given < count_max) {
    if (take_some(reader, std::min(kLoansMax, count_max - given), sink, context, given) > 0) continue;
    // Nothing is left: what is missing now will not come.
    if (keeps_past_) gaps_.forget_the_past();
    missing_.store(gaps_.missing(), std::memory_order_relaxed);
    break;
  }
  return given;
}

std::uint32_t eciton_reader::take_some(fast::DataReader& reader, std::uint32_t count_max, eciton_sink sink,
                                       void* context, std::uint32_t& given) {
  BytesSeq samples;
  fast::SampleInfoSeq infos;
  if (reader.take(samples, infos, static_cast<std::int32_t>(count_max)) != ReturnCode_t::RETCODE_OK) return 0;
  const auto taken = static_cast<std::uint32_t>(samples.length());
  for (std::int32_t k = 0; k < samples.length(); ++k) {
    if (participant_.owns(infos[k].publication_handle)) continue;
    const eciton::bus::vendors::WriterGuid writer = guid_of(infos[k].sample_identity);
    gaps_.observe(writer, infos[k].sample_identity.sequence_number().to64long());
    if (!infos[k].valid_data) continue;  // a writer went or disposed: the framework tells by fields and ages
    const Bytes& bytes = samples[k];
    std::uint8_t hash[16];
    if (!eciton::bus::vendors::well_formed(type_, bytes.cdr, bytes.size) ||
        !eciton::bus::vendors::key_hash_of(type_, bytes.cdr, bytes.size, false, hash)) {
      malformed_.fetch_add(1, std::memory_order_relaxed);
      continue;
    }
    origin_ = eciton::bus::vendors::origin_of(writer);
    sink(context, bytes.cdr, bytes.size);
    ++given;
  }
  reader.return_loan(samples, infos);
  return taken;
}

// The first call may come before create_datareader has returned: hence its own pointer.
void eciton_reader::on_data_available(fast::DataReader* reader) {
  if (delivery_.sample != nullptr) {
    take_from(*reader, std::numeric_limits<std::uint32_t>::max(), delivery_.sample, delivery_.context);
  } else if (delivery_.signal != nullptr) {
    delivery_.signal(delivery_.context);
  }
}

// What the vendor says is lost to a reliable reader was replaced in the writer's history before it was sent.
eciton_reader_losses eciton_reader::losses() const {
  const std::uint64_t missing = missing_.load(std::memory_order_relaxed);
  const std::uint64_t refused = rejected_.load(std::memory_order_relaxed);
  const std::uint64_t lost = reliable_ ? 0 : lost_.load(std::memory_order_relaxed);
  return {.lost = lost,
          .rejected = refused + malformed_.load(std::memory_order_relaxed),
          .replaced = missing - std::min(missing, lost + refused)};
}

void eciton_reader::on_sample_lost(fast::DataReader*, const fast::SampleLostStatus& status) {
  lost_.store(static_cast<std::uint32_t>(status.total_count), std::memory_order_relaxed);
}

void eciton_reader::on_sample_rejected(fast::DataReader*, const eprosima::fastrtps::SampleRejectedStatus& status) {
  rejected_.store(status.total_count, std::memory_order_relaxed);
}

void eciton_reader::on_subscription_matched(fast::DataReader*, const fast::SubscriptionMatchedStatus& status) {
  if (participant_.owns(status.last_publication_handle)) return;
  matched_.fetch_add(static_cast<std::uint32_t>(status.current_count_change), std::memory_order_relaxed);
}

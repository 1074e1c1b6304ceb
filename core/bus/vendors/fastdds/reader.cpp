// Reads bytes with Fast DDS: samples are taken on loan, so the sink sees the vendor's own buffer, unlocked.
#include <algorithm>
#include <fastdds/dds/core/LoanableSequence.hpp>

#include "core/bus/vendors/fastdds/bytes_type.hpp"
#include "core/bus/vendors/fastdds/endpoints.hpp"
#include "core/bus/vendors/request.hpp"

namespace fast = eprosima::fastdds::dds;
using eciton::Error;
using eciton::Result;
using eciton::bus::fastdds::Bytes;

namespace {

FASTDDS_SEQUENCE(BytesSeq, Bytes);

// Samples lent at once. Each holds a payload of the history's pool, which therefore has as many to spare.
constexpr std::uint32_t kLoansMax = 32;
// A reliable reader refuses a sample when the gap before it does not fit the history: leave room for a gap that a
// burst of losses makes. Payloads are allocated only when used.
constexpr std::uint32_t kSamplesSpare = kLoansMax + 224;

fast::DataReaderQos reader_qos(const eciton_qos& asked) {
  fast::DataReaderQos qos;
  eciton::bus::fastdds::set_common_qos(qos, asked, 1, kSamplesSpare);
  qos.reliable_reader_qos().times.heartbeatResponseDelay = eprosima::fastrtps::Duration_t(0, 0);
  qos.reader_resource_limits().max_samples_per_read = static_cast<std::int32_t>(kLoansMax);
  qos.reader_resource_limits().sample_infos_allocation.initial = kLoansMax;
  return qos;
}

}  // namespace

Result<eciton_reader*> eciton_reader::create(eciton_participant& participant, const char* topic,
                                             const eciton_type& type, const eciton_qos& qos, eciton_wake wake) {
  if (const eciton::Status checked = eciton::bus::vendors::check_endpoint(topic, type, qos); !checked) {
    return checked.error();
  }
  const Result<fast::Topic*> on = participant.topic(topic, type);
  if (!on) return on.error();
  std::unique_ptr<eciton_reader> created(new eciton_reader(participant, type, wake));
  created->reader_ = participant.subscriber->create_datareader(*on, reader_qos(qos), created.get(),
                                                               fast::StatusMask::data_available()
                                                                   << fast::StatusMask::subscription_matched());
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
  std::uint32_t given = 0;
  while (given < count_max) {
    if (take_some(std::min(kLoansMax, count_max - given), sink, context, given) == 0) break;
  }
  return given;
}

std::uint32_t eciton_reader::take_some(std::uint32_t count_max, eciton_sink sink, void* context,
                                       std::uint32_t& given) {
  BytesSeq samples;
  fast::SampleInfoSeq infos;
  if (reader_->take(samples, infos, static_cast<std::int32_t>(count_max)) != ReturnCode_t::RETCODE_OK) return 0;
  const auto taken = static_cast<std::uint32_t>(samples.length());
  for (std::int32_t k = 0; k < samples.length(); ++k) {
    if (!infos[k].valid_data) continue;  // a writer went or disposed: the framework tells by fields and ages
    if (participant_.owns(infos[k].publication_handle)) continue;
    const Bytes& bytes = samples[k];
    std::uint8_t hash[16];
    if (!eciton::bus::vendors::well_formed(type_, bytes.cdr, bytes.size)) continue;
    if (!eciton::bus::vendors::key_hash_of(type_, bytes.cdr, bytes.size, false, hash)) continue;
    sink(context, bytes.cdr, bytes.size);
    ++given;
  }
  reader_->return_loan(samples, infos);
  return taken;
}

void eciton_reader::on_data_available(fast::DataReader*) {
  if (wake_.signal != nullptr) wake_.signal(wake_.context);
}

void eciton_reader::on_subscription_matched(fast::DataReader*, const fast::SubscriptionMatchedStatus& status) {
  if (participant_.owns(status.last_publication_handle)) return;
  matched_.fetch_add(static_cast<std::uint32_t>(status.current_count_change), std::memory_order_relaxed);
}
